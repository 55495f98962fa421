// Who may read a journey: set when it is made, changed by SetReaders.
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

TEST_F(ServerTest, CreatingAgainWithOtherReadersIsRefused) {
  const auto create = [&](const std::vector<std::string>& readers) {
    v1::CreateJourneyRequest request;
    request.set_parent("robots/r");
    request.set_journey_id("out");
    request.set_writer_id(kWriter);
    for (const std::string& reader : readers) request.mutable_journey()->add_readers(reader);
    grpc::ClientContext context;
    v1::Journey made;
    return journeys_->CreateJourney(&context, request, &made);
  };
  EXPECT_THAT(create({"robots/a", "robots/b"}), IsGrpcOk());
  EXPECT_THAT(create({"robots/b", "robots/a"}), IsGrpcOk());
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{}, {"robots/a"}, {"*"}, {"robots/a", "robots/c"}}) {
    EXPECT_THAT(create(other),
                GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr("SetReaders")));
  }
  EXPECT_THAT(Get().readers(), ::testing::ElementsAre("robots/a", "robots/b"));
}

}  // namespace
}  // namespace homing::server
