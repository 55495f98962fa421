#include "server/session/recording_session.h"

#include <chrono>

#include "server/base/error_reason.h"
#include "tests/server/session/session_fixture.h"

namespace homing::server {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

class RecordingSessionTest : public SessionTest {
 protected:
  void SetUp() override { Create(); }

  // Frames of one camera; the bytes live as long as the fixture.
  Observation FrameAt(std::int64_t sequence) {
    Observation observation;
    observation.sequence = sequence;
    bytes_.push_back(
        std::make_unique<std::string>(test::WallAt(static_cast<int>(sequence), Side::kLeft)));
    observation.views[0] = test::GrayFrame(*bytes_.back());
    return observation;
  }

  JourneyMap Stored() { return store_->LoadMap(kJourney).value(); }

  std::vector<std::unique_ptr<std::string>> bytes_;
};

TEST_F(RecordingSessionTest, TheFirstAnswerSaysWhereToGoOn) {
  Ear ear;
  ASSERT_THAT(Open(&ear), IsOk());
  const auto answers = ear.AwaitAnswers(1);
  EXPECT_FALSE(answers[0].sequence);
  EXPECT_EQ(answers[0].next_sequence, 0);
  EXPECT_EQ(answers[0].resend_from, 0);
}

TEST_F(RecordingSessionTest, EveryAnsweredObservationIsOnDisk) {
  Ear ear;
  const auto session = Open(&ear).value();
  for (int i = 0; i < 5; ++i) {
    session->Record(test::FlowAt(i), {});
    const auto answers = ear.AwaitAnswers(static_cast<std::size_t>(i) + 2);
    EXPECT_EQ(answers.back().sequence, i);
    EXPECT_EQ(answers.back().next_sequence, i + 1);
    ASSERT_TRUE(answers.back().step);
    EXPECT_EQ(answers.back().step->step, i);
    EXPECT_FALSE(answers.back().step->fingerprints.empty());
    EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, i + 1);
    EXPECT_EQ(Stored().step_count(), i + 1);
  }
}

TEST_F(RecordingSessionTest, TimesInMemoryAreThoseOnDisk) {
  Ear ear;
  const auto session = Open(&ear).value();
  for (int i = 0; i < 3; ++i) {
    Observation frame = FrameAt(i);
    frame.capture_time_ns = 1000 + i;
    session->Record(frame, {});
  }
  ear.AwaitAnswers(4);
  const auto live = catalog_->Get(kJourney).value();
  const auto stored = store_->GetJourney(kJourney).value();
  EXPECT_EQ(stored.start_time_ns, 1001);
  EXPECT_EQ(live.start_time_ns, stored.start_time_ns);
  EXPECT_EQ(live.end_time_ns, stored.end_time_ns);
}

TEST_F(RecordingSessionTest, AGapNamesTheExpectedNumberAfterEarlierAnswers) {
  Ear ear;
  const auto session = Open(&ear).value();
  session->Record(test::FlowAt(0), {});
  session->Record(test::FlowAt(1), {});
  session->Record(test::FlowAt(5), {});
  const absl::Status end = ear.AwaitEnd();
  EXPECT_THAT(end, StatusIs(absl::StatusCode::kOutOfRange, "observation.sequence: 5 must be 2"));
  EXPECT_EQ(ReasonOf(end).reason, "SEQUENCE_GAP");
  EXPECT_EQ(ReasonOf(end).metadata.at("due"), "2");
  EXPECT_EQ(ear.AwaitAnswers(3).size(), 3u);
}

TEST_F(RecordingSessionTest, RepeatsAreAcceptedAndStoreNothing) {
  RecordFlow(0, 4);
  const JourneyMap before = Stored();
  Ear ear;
  const auto session = Open(&ear).value();
  EXPECT_EQ(ear.AwaitAnswers(1)[0].resend_from, 4);
  for (const int sequence : {0, 2, 3, 1}) {
    // Another place: it would show if it were stored.
    session->Record(test::FlowAt(sequence, 77), {});
  }
  const auto answers = ear.AwaitAnswers(5);
  EXPECT_EQ(answers[2].sequence, 2);
  EXPECT_FALSE(answers[2].step);
  EXPECT_EQ(answers[4].next_sequence, 4);
  ExpectSameMap(Stored(), before);
}

TEST_F(RecordingSessionTest, AnInterruptedRecordingOfFramesEqualsAnUndisturbedOne) {
  constexpr int kFrames = 12;
  Create("robots/r/journeys/whole");
  {
    Ear ear;
    const auto session = Open(&ear, {}, "writer", "robots/r/journeys/whole").value();
    for (int i = 0; i < kFrames; ++i) {
      session->Record(FrameAt(i), {});
    }
    ear.AwaitAnswers(kFrames + 1);
  }
  int next = 0;
  for (const int until : {1, 5, 6, kFrames}) {
    OpenStore(0);
    Ear ear;
    const auto session = Open(&ear).value();
    const auto first = ear.AwaitAnswers(1)[0];
    EXPECT_EQ(first.next_sequence, next);
    EXPECT_EQ(first.resend_from, std::max(0, next - 1));
    for (int i = static_cast<int>(first.resend_from); i < until; ++i) {
      session->Record(FrameAt(i), {});
    }
    const auto answers = ear.AwaitAnswers(static_cast<std::size_t>(until - first.resend_from) + 1);
    EXPECT_EQ(answers.back().next_sequence, until);
    next = until;
  }
  const JourneyMap whole = store_->LoadMap("robots/r/journeys/whole").value();
  EXPECT_EQ(whole.step_count(), kFrames - 1);
  EXPECT_GT(whole.all_fingerprints().size(), 5u);
  ExpectSameMap(Stored(), whole);
  EXPECT_EQ(Stored().settings(), whole.settings());
  EXPECT_EQ(whole.settings().cameras[0].width, test::kWidth);
}

TEST_F(RecordingSessionTest, FramesThatGoOnWithoutLookBackHaveAGapUnlessMarkedAsABreak) {
  {
    Ear ear;
    const auto session = Open(&ear).value();
    for (int i = 0; i < 3; ++i) {
      session->Record(FrameAt(i), {});
    }
    ear.AwaitAnswers(4);
  }
  Ear deaf;
  const auto hasty = Open(&deaf).value();
  hasty->Record(FrameAt(3), {});
  EXPECT_THAT(deaf.AwaitEnd(), StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("must be 2")));
  Ear ear;
  const auto session = Open(&ear).value();
  Observation marked = FrameAt(3);
  marked.break_before = true;
  session->Record(marked, {});
  const auto answers = ear.AwaitAnswers(2);
  EXPECT_EQ(answers.back().next_sequence, 4);
  EXPECT_EQ(answers.back().resend_from, 3);
  EXPECT_FALSE(answers.back().step);
  EXPECT_FALSE(answers.back().is_standing);
}

TEST_F(RecordingSessionTest, AJourneyOfFlowVectorsTakesNoFrames) {
  RecordFlow(0, 2);
  Ear ear;
  const auto session = Open(&ear).value();
  session->Record(FrameAt(2), {});
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kFailedPrecondition,
                                       HasSubstr("recorded with flow vectors")));
}

TEST_F(RecordingSessionTest, AnotherImageSizeAfterARestartIsRefused) {
  RecordFlow(0, 2);
  OpenStore(0);
  Ear ear;
  const auto session = Open(&ear).value();
  Observation other = test::FlowAt(2);
  other.views[0] = test::FieldAt(2, Side::kLeft, 640, 480);
  session->Record(other, {});
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("640")));
  EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, 2);
}

TEST_F(RecordingSessionTest, TheSameWriterTakesOverAndTheOldStreamIsAborted) {
  Ear old_ear;
  const auto old_session = Open(&old_ear).value();
  old_session->Record(test::FlowAt(0), {});
  Ear ear;
  const auto session = Open(&ear).value();
  EXPECT_THAT(old_ear.AwaitEnd(), StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  // The old stream's pending observations count.
  EXPECT_EQ(ear.AwaitAnswers(1)[0].next_sequence, 1);
  old_session->Record(test::FlowAt(1, 50), {});
  session->Record(test::FlowAt(1), {});
  EXPECT_EQ(ear.AwaitAnswers(2).back().next_sequence, 2);
  EXPECT_FALSE(ear.ended());
}

TEST_F(RecordingSessionTest, AnotherWriterIsRefusedWhileTheLeaseLives) {
  const TimePoint start{};
  Ear ear;
  const auto session = Open(&ear, start).value();
  session->Record(test::FlowAt(0), start + seconds(10));
  Ear other;
  EXPECT_THAT(Open(&other, start + seconds(24), "other"),
              StatusIs(absl::StatusCode::kAborted, HasSubstr("another writer holds")));
  EXPECT_THAT(Open(&other, start + seconds(25), "other"), IsOk());
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  EXPECT_EQ(store_->GetJourney(kJourney)->writer_id, "other");
}

TEST_F(RecordingSessionTest, AFinishedJourneyTakesNoWriter) {
  RecordFlow(0, 3);
  ASSERT_THAT(catalog_->Finish(kJourney, "writer", false, {}), IsOk());
  Ear ear;
  EXPECT_THAT(Open(&ear), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
  OpenStore(0);
  EXPECT_THAT(Open(&ear), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
}

TEST_F(RecordingSessionTest, FinishingEndsTheStreamAfterPendingAnswers) {
  Ear ear;
  const auto session = Open(&ear).value();
  for (int i = 0; i < 20; ++i) {
    session->Record(test::FlowAt(i), {});
  }
  EXPECT_THAT(catalog_->Finish(kJourney, "other", false, {}),
              StatusIs(absl::StatusCode::kAborted, HasSubstr("another writer")));
  const auto finished = catalog_->Finish(kJourney, "writer", false, {});
  ASSERT_THAT(finished, IsOk());
  EXPECT_EQ(finished->next_sequence, 20);
  EXPECT_EQ(finished->state, storage::JourneyState::kFinished);
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finish")));
  EXPECT_EQ(Stored().step_count(), 20);
}

TEST_F(RecordingSessionTest, ADeletedJourneysWriterIsAbortedAndTheNextOfTheNameBeginsEmpty) {
  Ear ear;
  const auto session = Open(&ear).value();
  session->Record(test::FlowAt(0), {});
  ASSERT_THAT(catalog_->Delete(kJourney), IsOk());
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kAborted, HasSubstr("deleted")));
  Create();
  session->Record(test::FlowAt(0), {});
  Ear next;
  ASSERT_THAT(Open(&next), IsOk());
  EXPECT_EQ(next.AwaitAnswers(1)[0].next_sequence, 0);
  EXPECT_EQ(Stored().step_count(), 0);
}

TEST_F(RecordingSessionTest, AFullDiskEndsTheStreamAndMemoryDoesNotRunAhead) {
  OpenStore(160 * 1024);
  Ear ear;
  const auto session = Open(&ear).value();
  for (int i = 0; i < 20'000 && !ear.ended(); ++i) {
    session->Record(test::FlowAt(i), {});
    if (i % 50 == 49) {
      ear.AwaitAnswers(static_cast<std::size_t>(i));
    }
  }
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("")));
  const std::int64_t durable = store_->GetJourney(kJourney)->next_sequence;
  EXPECT_GT(durable, 0);
  EXPECT_EQ(ear.AwaitAnswers(1).back().next_sequence, durable);
  const auto live = catalog_->Open(kJourney).value();
  EXPECT_EQ(live->record().next_sequence, durable);
  const LiveJourneys one = {live};
  const MapsLock lock(one);
  ExpectSameMap(live->map(), Stored());
}

TEST_F(RecordingSessionTest, AnUnknownJourneyIsNotFoundAndABadNameInvalid) {
  Ear ear;
  EXPECT_THAT(Open(&ear, {}, "writer", "robots/r/journeys/none"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("robots/r/journeys/none")));
  EXPECT_THAT(Open(&ear, {}, "writer", "robots/r"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("config.journey")));
  EXPECT_THAT(Open(&ear, {}, ""),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("config.writer_id")));
}

TEST_F(RecordingSessionTest, ABadObservationEndsTheStreamAndTheNextStreamContinues) {
  {
    Ear ear;
    const auto session = Open(&ear).value();
    session->Record(test::FlowAt(0), {});
    Observation empty;
    empty.sequence = 1;
    session->Record(empty, {});
    EXPECT_THAT(ear.AwaitEnd(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("observation.left: ")));
  }
  RecordFlow(1, 4);
  EXPECT_EQ(Stored().step_count(), 4);
}

}  // namespace
}  // namespace homing::server
