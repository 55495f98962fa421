// The unary RPCs.
#include "homing/landmark/landmark_options.h"
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JourneyServiceTest : public ServerTest {
 protected:
  grpc::Status CreateWith(const v1::CreateJourneyRequest& request) {
    grpc::ClientContext context;
    v1::Journey made;
    return journeys_->CreateJourney(&context, request, &made);
  }
  static v1::CreateJourneyRequest Request() {
    v1::CreateJourneyRequest request;
    request.set_parent("robots/r");
    request.set_journey_id("out");
    request.set_writer_id(kWriter);
    return request;
  }
  grpc::Status List(const std::string& parent, int size, const std::string& token,
                    v1::ListJourneysResponse* response) {
    grpc::ClientContext context;
    v1::ListJourneysRequest request;
    request.set_parent(parent);
    request.set_page_size(size);
    request.set_page_token(token);
    return journeys_->ListJourneys(&context, request, response);
  }
  std::vector<std::string> NamesOf(const v1::ListJourneysResponse& response) {
    std::vector<std::string> names;
    for (const v1::Journey& journey : response.journeys()) {
      names.push_back(journey.name());
    }
    return names;
  }
  grpc::Status Delete(const std::string& name) {
    grpc::ClientContext context;
    v1::DeleteJourneyRequest request;
    request.set_name(name);
    v1::DeleteJourneyResponse response;
    return journeys_->DeleteJourney(&context, request, &response);
  }
  grpc::Status Landmarks(const v1::ListLandmarksRequest& request,
                         v1::ListLandmarksResponse* response) {
    grpc::ClientContext context;
    return journeys_->ListLandmarks(&context, request, response);
  }
};

TEST_F(JourneyServiceTest, ANewJourneyIsActiveAndEmptyWithTheDefaultSettings) {
  v1::Journey made;
  ASSERT_THAT(Create("out", kWriter, &made), IsGrpcOk());
  EXPECT_EQ(made.name(), kJourney);
  EXPECT_EQ(made.state(), v1::Journey::STATE_ACTIVE);
  EXPECT_EQ(made.step_count(), 0);
  EXPECT_EQ(made.next_sequence(), 0);
  EXPECT_GT(made.create_time().seconds(), 1'600'000'000);
  EXPECT_EQ(made.settings().deviation_model(), "deviationModels/default");
  EXPECT_EQ(made.settings().landmark().min_vectors(), LandmarkOptions().min_vectors);
  EXPECT_EQ(Get().SerializeAsString(), made.SerializeAsString());
}

TEST_F(JourneyServiceTest, CreatingAgainIsIdempotentForTheSameWriterAndSettings) {
  v1::Journey first;
  v1::Journey again;
  ASSERT_THAT(Create("out", kWriter, &first), IsGrpcOk());
  RecordFlow(0, 2);
  ASSERT_THAT(Create("out", kWriter, &again), IsGrpcOk());
  EXPECT_EQ(again.next_sequence(), 2);
  EXPECT_EQ(again.settings().left_camera().width(), test::kWidth);
  EXPECT_THAT(Create("out", "other"),
              GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr(kJourney)));
  v1::CreateJourneyRequest request = Request();
  *request.mutable_journey()->mutable_settings()->mutable_landmark() = first.settings().landmark();
  request.mutable_journey()->mutable_settings()->mutable_landmark()->set_min_vectors(9);
  EXPECT_THAT(CreateWith(request),
              GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr("other settings")));
  ASSERT_THAT(Finish(), IsGrpcOk());
  EXPECT_THAT(Create(), GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr("finished")));
}

TEST_F(JourneyServiceTest, WrongFieldsOfCreateAreNamed) {
  v1::CreateJourneyRequest request = Request();
  request.set_parent("robots/-");
  EXPECT_EQ(BadFieldOf(CreateWith(request)), "parent");
  request = Request();
  request.set_journey_id("a/b");
  EXPECT_EQ(BadFieldOf(CreateWith(request)), "journey_id");
  request = Request();
  request.set_writer_id(std::string(200, 'w'));
  EXPECT_EQ(BadFieldOf(CreateWith(request)), "writer_id");
  request = Request();
  request.mutable_journey()->add_readers("everyone");
  EXPECT_EQ(BadFieldOf(CreateWith(request)), "journey.readers[0]");
  request = Request();
  request.mutable_journey()->mutable_settings()->mutable_left_camera()->set_width(-5);
  EXPECT_EQ(BadFieldOf(CreateWith(request)), "journey.settings.left_camera.width");
  request = Request();
  request.mutable_journey()->mutable_settings()->set_deviation_model("deviationModels/none");
  EXPECT_THAT(CreateWith(request),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("deviationModels/none")));
}

TEST_F(JourneyServiceTest, AVeryLongNameGivesAShortError) {
  v1::CreateJourneyRequest request = Request();
  request.set_journey_id(std::string(1 << 20, 'x'));
  const grpc::Status status = CreateWith(request);
  EXPECT_THAT(status, GrpcStatusIs(kInvalid, HasSubstr("journey_id")));
  EXPECT_LT(status.error_message().size(), 1100u);
}

TEST_F(JourneyServiceTest, GetAndDeleteTellMissingFromWrongNames) {
  grpc::ClientContext context;
  v1::GetJourneyRequest request;
  request.set_name(kJourney);
  v1::Journey journey;
  EXPECT_THAT(journeys_->GetJourney(&context, request, &journey),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr(kJourney)));
  EXPECT_THAT(Delete(kJourney), GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr(kJourney)));
  EXPECT_THAT(Delete("robots/r/journeys/-"), GrpcStatusIs(kInvalid, HasSubstr("wildcard")));
  EXPECT_THAT(Finish(), GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr(kJourney)));
}

TEST_F(JourneyServiceTest, JourneysAreListedInOrderPageByPage) {
  for (const char* id : {"c", "a", "e", "b", "d"}) {
    ASSERT_THAT(Create(id), IsGrpcOk());
  }
  v1::CreateJourneyRequest other = Request();
  other.set_parent("robots/q");
  ASSERT_THAT(CreateWith(other), IsGrpcOk());
  v1::ListJourneysResponse page;
  ASSERT_THAT(List("robots/r", 3, "", &page), IsGrpcOk());
  EXPECT_THAT(NamesOf(page),
              ElementsAre("robots/r/journeys/a", "robots/r/journeys/b", "robots/r/journeys/c"));
  const std::string token = page.next_page_token();
  ASSERT_FALSE(token.empty());
  ASSERT_THAT(List("robots/r", 3, token, &page), IsGrpcOk());
  EXPECT_THAT(NamesOf(page), ElementsAre("robots/r/journeys/d", "robots/r/journeys/e"));
  EXPECT_EQ(page.next_page_token(), "");
  ASSERT_THAT(List("robots/-", 0, "", &page), IsGrpcOk());
  EXPECT_EQ(page.journeys_size(), 6);
  EXPECT_EQ(page.journeys(0).name(), "robots/q/journeys/out");
  EXPECT_EQ(BadFieldOf(List("robots/-", 0, token, &page)), "page_token");
  EXPECT_EQ(BadFieldOf(List("robots/r", 0, "!", &page)), "page_token");
  EXPECT_EQ(BadFieldOf(List("robots/r", 1001, "", &page)), "page_size");
  EXPECT_EQ(BadFieldOf(List("robots/r", -1, "", &page)), "page_size");
  EXPECT_EQ(BadFieldOf(List("r", 0, "", &page)), "parent");
}

TEST_F(JourneyServiceTest, ADeletedJourneyIsNotFoundAndItsWriterAborted) {
  ASSERT_THAT(Create(), IsGrpcOk());
  Recording recording(journeys_.get(), kJourney);
  recording.Record(test::FlowAt(0));
  ASSERT_THAT(Delete(kJourney), IsGrpcOk());
  EXPECT_THAT(recording.AwaitEnd(), GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("deleted")));
  v1::ListJourneysResponse page;
  ASSERT_THAT(List("robots/-", 0, "", &page), IsGrpcOk());
  EXPECT_EQ(page.journeys_size(), 0);
}

TEST_F(JourneyServiceTest, FinishingIsIdempotentAndOnlyForTheWriterWhileItsLeaseLives) {
  ASSERT_THAT(Create(), IsGrpcOk());
  {
    Recording recording(journeys_.get(), kJourney);
    recording.Record(test::FlowAt(0));
    EXPECT_THAT(Finish(kJourney, ""), GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("force")));
    EXPECT_THAT(recording.Close(), IsGrpcOk());
  }
  EXPECT_THAT(Finish(kJourney, "other"),
              GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("another writer")));
  EXPECT_THAT(Finish(), IsGrpcOk());
  EXPECT_THAT(Finish(), IsGrpcOk());
  EXPECT_EQ(Get().state(), v1::Journey::STATE_FINISHED);
  ASSERT_THAT(Create("lapsed"), IsGrpcOk());
  // Without a writer_id: as soon as no stream records it.
  RecordFlow(0, 3, "robots/r/journeys/lapsed");
  const auto finish = [&] { return Finish("robots/r/journeys/lapsed", ""); };
  EXPECT_THAT(AfterStreamEnd(finish), IsGrpcOk());
}

TEST_F(JourneyServiceTest, AliasingIsReportedForAMapWithProfiles) {
  ASSERT_THAT(Create(), IsGrpcOk());
  v1::AnalyzeAliasingRequest request;
  request.set_name(kJourney);
  v1::AnalyzeAliasingResponse report;
  const auto analyze = [&] {
    grpc::ClientContext context;
    return journeys_->AnalyzeAliasing(&context, request, &report);
  };
  EXPECT_THAT(analyze(),
              GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION, HasSubstr("no flow profiles")));
  RecordFlow(0, 60);
  ASSERT_THAT(analyze(), IsGrpcOk());
  EXPECT_GE(report.median_steps(), 1);
  request.set_tolerance_steps(-1);
  EXPECT_THAT(analyze(),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("tolerance_steps")));
  request.clear_tolerance_steps();
  request.set_name("robots/r/journeys/none");
  EXPECT_THAT(analyze(), GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("none")));
}

TEST_F(JourneyServiceTest, LandmarksAreListedWithTheirFingerprintsPageByPage) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 60);
  v1::ListLandmarksRequest request;
  request.set_parent(kJourney);
  request.set_include_fingerprints(true);
  v1::ListLandmarksResponse all;
  ASSERT_THAT(Landmarks(request, &all), IsGrpcOk());
  ASSERT_GT(all.landmarks_size(), 2);
  EXPECT_EQ(all.landmarks_size(), Get().landmark_count());
  std::int64_t fingerprints = 0;
  for (int i = 0; i < all.landmarks_size(); ++i) {
    const v1::Landmark& landmark = all.landmarks(i);
    EXPECT_EQ(landmark.landmark(), i);
    EXPECT_EQ(landmark.steps_size(), landmark.fingerprint_count());
    EXPECT_EQ(landmark.xs_size(), landmark.steps_size());
    EXPECT_EQ(landmark.steps(0), landmark.first_step());
    EXPECT_EQ(*landmark.steps().rbegin(), landmark.last_step());
    fingerprints += landmark.fingerprint_count();
  }
  EXPECT_EQ(fingerprints, Get().fingerprint_count());
  request.set_page_size(2);
  v1::ListLandmarksResponse page;
  ASSERT_THAT(Landmarks(request, &page), IsGrpcOk());
  EXPECT_EQ(page.landmarks_size(), 2);
  request.set_page_token(page.next_page_token());
  ASSERT_THAT(Landmarks(request, &page), IsGrpcOk());
  EXPECT_EQ(page.landmarks(0).SerializeAsString(), all.landmarks(2).SerializeAsString());
  request.set_parent("robots/r/journeys/none");
  request.clear_page_token();
  EXPECT_THAT(Landmarks(request, &page),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("none")));
}

}  // namespace
}  // namespace homing::server
