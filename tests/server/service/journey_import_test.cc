// The files of export and import.
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class JourneyImportTest : public ServerTest {
 protected:
  grpc::Status List(v1::ListJourneysResponse* response) {
    grpc::ClientContext context;
    v1::ListJourneysRequest request;
    request.set_parent("robots/-");
    return journeys_->ListJourneys(&context, request, response);
  }
};

TEST_F(JourneyImportTest, AnImportedFileExportsToTheSameBytes) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 50);
  ASSERT_THAT(Finish(), IsGrpcOk());
  const std::string file = Export();
  ASSERT_THAT(Import("robots/q/journeys/copy", file), IsGrpcOk());
  EXPECT_EQ(Export("robots/q/journeys/copy"), file);
  const v1::Journey copy = Get("robots/q/journeys/copy");
  EXPECT_EQ(copy.state(), v1::Journey::STATE_FINISHED);
  EXPECT_EQ(copy.fingerprint_count(), Get().fingerprint_count());
  StartServer();
  EXPECT_EQ(Export("robots/q/journeys/copy"), file);
}

TEST_F(JourneyImportTest, ACancelledImportStoresNothing) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 10);
  const std::string file = Export();
  for (int i = 0; i < 10; ++i) {
    grpc::ClientContext context;
    v1::ImportJourneyResponse response;
    const auto stream = journeys_->ImportJourney(&context, &response);
    v1::ImportJourneyRequest request;
    request.set_name("robots/r/journeys/copy");
    ASSERT_TRUE(stream->Write(request));
    request.set_chunk(file);
    ASSERT_TRUE(stream->Write(request));
    context.TryCancel();
    EXPECT_THAT(stream->Finish(), GrpcStatusIs(grpc::StatusCode::CANCELLED, HasSubstr("")));
  }
  // The server has ended them all once it has drained.
  StartServer();
  v1::ListJourneysResponse page;
  ASSERT_THAT(List(&page), IsGrpcOk());
  EXPECT_EQ(page.journeys_size(), 1);
}

TEST_F(JourneyImportTest, WrongImportsAreRefused) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 10);
  const std::string file = Export();
  EXPECT_THAT(Import(kJourney, file),
              GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr(kJourney)));
  std::string damaged = file;
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_THAT(Import("robots/r/journeys/new", damaged), GrpcStatusIs(kInvalid, HasSubstr("")));
  EXPECT_THAT(Import("robots/r/journeys/new", file.substr(0, file.size() / 2)),
              GrpcStatusIs(kInvalid, HasSubstr("")));
  EXPECT_THAT(Import("robots/r/journeys/new", ""), GrpcStatusIs(kInvalid, HasSubstr("")));
  EXPECT_THAT(Import("", file), GrpcStatusIs(kInvalid, HasSubstr("first message must be name")));
  EXPECT_THAT(Import("robots/-/journeys/new", file), GrpcStatusIs(kInvalid, HasSubstr("wildcard")));
  v1::ListJourneysResponse page;
  ASSERT_THAT(List(&page), IsGrpcOk());
  EXPECT_EQ(page.journeys_size(), 1);
}

TEST_F(JourneyImportTest, AnImportCountsTowardsTheRobotsBytes) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 10);
  ASSERT_THAT(Finish(), IsGrpcOk());
  const std::string file = Export();
  options_.limits.max_robot_bytes = 10 * 2 * 128;
  StartServer();
  EXPECT_THAT(Import("robots/q/journeys/new", file),
              GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("with this journey")));
}

TEST_F(JourneyImportTest, ARefusedImportDeletesNothingToMakeRoom) {
  options_.limits.max_robot_journeys = 1;
  options_.limits.delete_oldest = true;
  StartServer();
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 10);
  ASSERT_THAT(Finish(), IsGrpcOk());
  const std::string file = Export();
  for (const std::string& damaged : {file.substr(0, file.size() - 1), std::string()}) {
    EXPECT_THAT(Import("robots/r/journeys/new", damaged), GrpcStatusIs(kInvalid, HasSubstr("")));
    EXPECT_EQ(Get().state(), v1::Journey::STATE_FINISHED);
  }
  EXPECT_THAT(Import("robots/r/journeys/new", file), IsGrpcOk());
  v1::ListJourneysResponse page;
  ASSERT_THAT(List(&page), IsGrpcOk());
  ASSERT_EQ(page.journeys_size(), 1);
  EXPECT_EQ(page.journeys(0).name(), "robots/r/journeys/new");
}

}  // namespace
}  // namespace homing::server
