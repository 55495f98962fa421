// Queries: wildcards, changed sides, wrong questions, one-shot matching.
#include <limits>
#include <set>

#include "homing/flow/observation.h"
#include "homing/image/frame.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class HomingServiceTest : public ServerTest {
 protected:
  void SetUp() override { ASSERT_THAT(Create(), IsGrpcOk()); }
  // Numbered from 0.
  void RecordPlaces(int first, int last, const std::string& name) {
    Recording recording(journeys_.get(), name);
    for (int place = first; place < last; ++place) {
      recording.Record(test::FlowAt(place - first, place));
    }
    EXPECT_THAT(recording.Close(), IsGrpcOk());
  }
  grpc::Status Delete(const std::string& name) {
    grpc::ClientContext context;
    v1::DeleteJourneyRequest request;
    request.set_name(name);
    v1::DeleteJourneyResponse response;
    return journeys_->DeleteJourney(&context, request, &response);
  }
};

TEST_F(HomingServiceTest, AWildcardSkipsJourneysOfAnotherCamera) {
  RecordFlow(0, 20);
  ASSERT_THAT(Create("wide"), IsGrpcOk());
  {
    Recording recording(journeys_.get(), "robots/r/journeys/wide");
    Observation wide;
    wide.views[0] = test::FieldAt(0, Side::kLeft, 640, 480);
    wide.views[1] = test::FieldAt(0, Side::kRight, 640, 480);
    recording.Record(wide);
  }
  for (const char* pattern :
       {"robots/r/journeys/-", "robots/-/journeys/-", "robots/-/journeys/out"}) {
    Localizing localizing(homing_.get(), LocalizeOn(pattern));
    const v1::LocalizeResponse answer = localizing.Localize(test::FlowAt(0, 7));
    ASSERT_GT(answer.matches_size(), 0) << pattern;
    EXPECT_EQ(answer.matches(0).journey(), kJourney);
  }
  Localizing none_left(homing_.get(), LocalizeOn("robots/-/journeys/wide"));
  none_left.Send(test::FlowAt(0));
  EXPECT_THAT(none_left.AwaitEnd(), GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION,
                                                 HasSubstr("none has the camera")));
  Localizing nothing(homing_.get(), LocalizeOn("robots/nobody/journeys/-"));
  EXPECT_THAT(nothing.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("robots/nobody")));
}

std::set<std::string> JourneysIn(const v1::LocalizeResponse& answer) {
  std::set<std::string> journeys;
  if (!answer.journey().empty()) journeys.insert(answer.journey());
  for (const v1::Match& match : answer.matches()) journeys.insert(match.journey());
  return journeys;
}

TEST_F(HomingServiceTest, ADeletedJourneyLeavesTheStreamsOfAWildcard) {
  const std::string other = "robots/r/journeys/other";
  ASSERT_THAT(Create("other"), IsGrpcOk());
  RecordFlow(0, 60);
  RecordPlaces(20, 60, other);
  Localizing localizing(homing_.get(), LocalizeOn("robots/-/journeys/-"));
  std::set<std::string> seen;
  int place = 20;
  v1::LocalizeResponse answer;
  for (int i = 0; i < 15; ++i) {
    answer = localizing.Localize(test::FlowAt(i, place++));
    seen.merge(JourneysIn(answer));
  }
  EXPECT_EQ(seen, (std::set<std::string>{kJourney, other}));
  ASSERT_THAT(Delete(answer.journey()), IsGrpcOk());
  const std::string left = answer.journey() == kJourney ? other : kJourney;
  // One that is made meanwhile is not covered.
  ASSERT_THAT(Create("late"), IsGrpcOk());
  RecordPlaces(20, 60, "robots/r/journeys/late");
  for (int i = 15; i < 35; ++i) {
    answer = localizing.Localize(test::FlowAt(i, place++));
    EXPECT_EQ(JourneysIn(answer), (std::set<std::string>{left})) << i;
  }
  EXPECT_EQ(answer.outcome(), v1::OUTCOME_MATCH);
  ASSERT_THAT(Delete(left), IsGrpcOk());
  ASSERT_TRUE(localizing.Send(test::FlowAt(35, place)));
  EXPECT_THAT(localizing.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("was deleted")));
}

TEST_F(HomingServiceTest, TheBeliefGoesOnWhenAnotherJourneyIsDeleted) {
  ASSERT_THAT(Create("other"), IsGrpcOk());
  RecordFlow(0, 60);
  RecordPlaces(200, 260, "robots/r/journeys/other");
  Localizing localizing(homing_.get(), LocalizeOn("robots/-/journeys/-"));
  v1::LocalizeResponse answer;
  for (int i = 0; i < 35; ++i) answer = localizing.Localize(test::FlowAt(i, 10 + i));
  ASSERT_NE(answer.outcome(), v1::OUTCOME_UNKNOWN_PLACE);
  ASSERT_THAT(Delete("robots/r/journeys/other"), IsGrpcOk());
  answer = localizing.Localize(test::FlowAt(35, 45));
  EXPECT_NE(answer.outcome(), v1::OUTCOME_UNKNOWN_PLACE);
  EXPECT_EQ(answer.journey(), kJourney);
  EXPECT_NEAR(static_cast<double>(answer.step()), 45, 3);
}

TEST_F(HomingServiceTest, OnTheWayBackTheCamerasHaveChangedSides) {
  RecordFlow(0, 20);
  Observation back = test::FlowAt(0, 7);
  std::swap(back.views[0], back.views[1]);
  Localizing localizing(homing_.get(), LocalizeOn(kJourney, v1::TRAVEL_RETURN));
  const v1::LocalizeResponse answer = localizing.Localize(back);
  ASSERT_GT(answer.matches_size(), 1);
  EXPECT_DOUBLE_EQ(answer.matches(1).p_t(), 1);
}

TEST_F(HomingServiceTest, WrongQueriesAreInvalid) {
  v1::LocalizeConfig config = LocalizeOn("robots/r");
  EXPECT_THAT(Localizing(homing_.get(), config).AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("config.journey")));
  config = LocalizeOn(kJourney);
  config.set_threshold(1.5);
  EXPECT_THAT(Localizing(homing_.get(), config).AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("threshold")));
  config = LocalizeOn(kJourney);
  config.set_max_matches(1001);
  EXPECT_THAT(Localizing(homing_.get(), config).AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("max_matches")));
  config = LocalizeOn(kJourney, static_cast<v1::Travel>(9));
  EXPECT_THAT(Localizing(homing_.get(), config).AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("travel")));
  RecordFlow(0, 20);
  config = LocalizeOn(kJourney);
  config.mutable_prior()->set_journey(kJourney);
  config.mutable_prior()->set_direction(static_cast<v1::Direction>(9));
  EXPECT_THAT(
      Localizing(homing_.get(), config).AwaitEnd(),
      GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("config.prior.direction: 9")));
  config.mutable_prior()->clear_direction();
  config.mutable_prior()->set_path_offset(std::numeric_limits<double>::quiet_NaN());
  Localizing unclear(homing_.get(), config);
  unclear.Send(test::FlowAt(0));
  EXPECT_THAT(unclear.AwaitEnd(), GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT,
                                               HasSubstr("config.prior.path_offset: nan")));
}

// Two frames, their flow vectors and their fingerprints are one question in three forms.
TEST_F(HomingServiceTest, OneShotMatchingTakesFramesFlowVectorsAndFingerprints) {
  const std::string before = test::WallAt(4, Side::kLeft);
  const std::string after = test::WallAt(5, Side::kLeft);
  Recording recording(journeys_.get(), kJourney);
  for (int i = 0; i < 10; ++i) {
    const std::string bytes = test::WallAt(i, Side::kLeft);
    Observation observation;
    observation.sequence = i;
    observation.views[0] = test::GrayFrame(bytes);
    recording.Record(observation);
  }
  const auto match = [this](const v1::MatchLandmarksRequest& request) {
    grpc::ClientContext context;
    v1::MatchLandmarksResponse response;
    EXPECT_THAT(homing_->MatchLandmarks(&context, request, &response), IsGrpcOk());
    return response;
  };
  v1::MatchLandmarksRequest frames;
  frames.set_journey(kJourney);
  frames.set_travel(v1::TRAVEL_SAME);
  Observation pair;
  pair.views[0] = test::GrayFrame(before);
  *frames.mutable_left()->mutable_frames()->mutable_first() =
      RecordRequest(pair).observation().left().frame();
  pair.views[0] = test::GrayFrame(after);
  *frames.mutable_left()->mutable_frames()->mutable_second() =
      RecordRequest(pair).observation().left().frame();
  const v1::MatchLandmarksResponse seen = match(frames);
  EXPECT_EQ(seen.motion(), v1::MOTION_MOVING);
  ASSERT_GT(seen.matches_size(), 0);
  EXPECT_EQ(seen.matches(0).step(), 4);
  EXPECT_DOUBLE_EQ(seen.matches(0).p_t(), 1);

  v1::MatchLandmarksRequest fingerprints = frames;
  auto* set = fingerprints.mutable_left()->mutable_fingerprints();
  set->set_width(test::kWidth);
  set->set_height(test::kHeight);
  *set->mutable_fingerprints() = seen.seen();
  const v1::MatchLandmarksResponse again = match(fingerprints);
  ASSERT_EQ(again.matches_size(), seen.matches_size());
  EXPECT_EQ(again.matches(0).SerializeAsString(), seen.matches(0).SerializeAsString());

  set->set_width(640);
  grpc::ClientContext context;
  v1::MatchLandmarksResponse response;
  EXPECT_THAT(homing_->MatchLandmarks(&context, fingerprints, &response),
              GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION, HasSubstr("640")));
  fingerprints.clear_left();
  grpc::ClientContext empty_context;
  EXPECT_THAT(homing_->MatchLandmarks(&empty_context, fingerprints, &response),
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("left")));
}

}  // namespace
}  // namespace homing::server
