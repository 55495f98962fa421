// Recording that continues from a reference frame, and steps that are not made.
#include "server/session/recording_session.h"
#include "tests/server/session/session_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class RecordingReferenceTest : public SessionTest {
 protected:
  void SetUp() override { Create(); }

  // A frame of one camera; the bytes live as long as the fixture.
  Observation FrameAt(std::int64_t sequence, int place) {
    Observation observation;
    observation.sequence = sequence;
    bytes_.push_back(std::make_unique<std::string>(test::WallAt(place, Side::kLeft)));
    observation.views[0] = test::GrayFrame(*bytes_.back());
    return observation;
  }

  JourneyMap Stored() { return store_->LoadMap(kJourney).value(); }

  std::vector<std::unique_ptr<std::string>> bytes_;
};

// Seven frames at each place. The server is killed after each number of frames, and sees the
// reference and then only what is not durable.
TEST_F(RecordingReferenceTest, ASlowRobotGoesOnFromItsReferenceManyFramesBack) {
  constexpr int kFrames = 30;
  constexpr int kFramesAPlace = 7;
  Create("robots/r/journeys/whole");
  {
    Ear whole_ear;
    const auto whole_session = Open(&whole_ear, {}, "writer", "robots/r/journeys/whole").value();
    for (int i = 0; i < kFrames; ++i) {
      whole_session->Record(FrameAt(i, i / kFramesAPlace), {});
      const RecordingAnswer answer = whole_ear.AwaitAnswers(static_cast<std::size_t>(i) + 2).back();
      EXPECT_EQ(answer.next_sequence, i + 1);
      EXPECT_EQ(answer.resend_from, i - i % kFramesAPlace);
      EXPECT_EQ(answer.step.has_value(), i > 0 && i % kFramesAPlace == 0);
      EXPECT_EQ(answer.is_standing, i % kFramesAPlace != 0);
    }
  }
  for (int next = 0; next < kFrames; ++next) {
    OpenStore(0);
    Ear ear;
    const auto session = Open(&ear).value();
    const auto first = ear.AwaitAnswers(1)[0];
    EXPECT_EQ(first.next_sequence, next);
    const int reference = next == 0 ? 0 : (next - 1) - (next - 1) % kFramesAPlace;
    ASSERT_EQ(first.resend_from, reference);
    EXPECT_EQ(first.frame, reference > 0 ? std::optional<std::int64_t>(reference) : std::nullopt);
    std::size_t sent = 1;
    if (reference < next) {
      session->Record(FrameAt(reference, reference / kFramesAPlace), {});
      ++sent;
    }
    session->Record(FrameAt(next, next / kFramesAPlace), {});
    EXPECT_EQ(ear.AwaitAnswers(sent + 1).back().next_sequence, next + 1);
  }
  const JourneyMap whole = store_->LoadMap("robots/r/journeys/whole").value();
  EXPECT_EQ(whole.step_count(), (kFrames - 1) / kFramesAPlace);
  EXPECT_EQ(whole.sequence(1), 2 * kFramesAPlace);
  ExpectSameMap(Stored(), whole);
}

TEST_F(RecordingReferenceTest, FramesBetweenTheReferenceAndTheNextMayComeOrNot) {
  {
    Ear ear;
    const auto session = Open(&ear).value();
    for (int i = 0; i < 6; ++i) session->Record(FrameAt(i, 0), {});
    ear.AwaitAnswers(7);
  }
  Ear ear;
  const auto session = Open(&ear).value();
  EXPECT_EQ(ear.AwaitAnswers(1)[0].resend_from, 0);
  for (const int i : {0, 2, 5, 6}) session->Record(FrameAt(i, i / 6), {});
  const auto answers = ear.AwaitAnswers(5);
  EXPECT_EQ(answers.back().next_sequence, 7);
  ASSERT_TRUE(answers.back().step);
  EXPECT_EQ(answers.back().step->sequence, 6);
  EXPECT_EQ(Stored().step_count(), 1);
}

TEST_F(RecordingReferenceTest, AStandingCameraStoresNoStep) {
  Ear ear;
  const auto session = Open(&ear).value();
  for (int i = 0; i < 40; ++i) session->Record(FrameAt(i, 0), {});
  ear.AwaitAnswers(41);
  const auto stored = store_->GetJourney(kJourney).value();
  EXPECT_EQ(stored.next_sequence, 40);
  EXPECT_EQ(stored.resend_from, 0);
  EXPECT_EQ(stored.step_count, 0);
}

TEST_F(RecordingReferenceTest, StepsOfFlowKeepTheFramesThatTheClientNames) {
  {
    Ear ear;
    const auto session = Open(&ear).value();
    for (int i = 0; i < 3; ++i) {
      Observation observation = test::FlowAt(i);
      observation.frame = 10 * i + 4;
      session->Record(observation, {});
    }
    EXPECT_EQ(ear.AwaitAnswers(4).back().frame, 24);
  }
  OpenStore(0);
  Ear again;
  const auto resumed = Open(&again).value();
  EXPECT_EQ(again.AwaitAnswers(1)[0].frame, 24);
  EXPECT_EQ(again.AwaitAnswers(1)[0].resend_from, 3);
  EXPECT_EQ(Stored().sequence(1), 14);
  Observation late = test::FlowAt(3);
  late.frame = 24;
  resumed->Record(late, {});
  EXPECT_THAT(again.AwaitEnd(), StatusIs(absl::StatusCode::kInvalidArgument,
                                         HasSubstr("observation.frame: 24 must be over 24")));
}

}  // namespace
}  // namespace homing::server
