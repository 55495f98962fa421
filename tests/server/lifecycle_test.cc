// Streams over the life of the server: takeover, drain, restart, many at once.
#include <thread>

#include "homing/flow/observation.h"
#include "homing/image/frame.h"
#include "server/config/health_check.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class LifecycleTest : public ServerTest {
 protected:
  void SetUp() override { ASSERT_THAT(Create(), IsGrpcOk()); }
};

Observation FramesAt(std::int64_t sequence, const std::string& left, const std::string& right) {
  Observation observation;
  observation.sequence = sequence;
  observation.capture_time_ns = 1'700'000'000'000'000'000 + sequence * 100'000'000;
  observation.views = {test::GrayFrame(left), test::GrayFrame(right)};
  return observation;
}

TEST_F(LifecycleTest, TheSameWriterTakesOverAndTheOldStreamIsAborted) {
  Recording old_stream(journeys_.get(), kJourney);
  old_stream.Record(test::FlowAt(0));
  Recording stream(journeys_.get(), kJourney);
  v1::RecordJourneyResponse first;
  ASSERT_TRUE(stream.Read(&first));
  EXPECT_EQ(first.next_sequence(), 1);
  EXPECT_EQ(first.resend_from(), 1);
  const grpc::Status status = old_stream.AwaitEnd();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("taken over")));
  EXPECT_EQ(ReasonOf(status), "WRITER_REPLACED");
  EXPECT_EQ(stream.Record(test::FlowAt(1)).next_sequence(), 2);
}

TEST_F(LifecycleTest, AnotherWriterMayGoOnWhenTheLeaseHasRunOut) {
  RecordFlow(0, 2);
  Wait(std::chrono::seconds(16));
  Recording other(journeys_.get(), kJourney, "other");
  EXPECT_EQ(other.Record(test::FlowAt(2)).next_sequence(), 3);
}

TEST_F(LifecycleTest, AJourneyIsLocalisedOnWhileItIsRecorded) {
  Recording recording(journeys_.get(), kJourney);
  for (int place = 0; place < 30; ++place) {
    recording.Record(test::FlowAt(place));
  }
  Localizing localizing(homing_.get(), LocalizeOn(kJourney));
  v1::LocalizeResponse answer;
  for (int i = 0; i < 12; ++i) {
    answer = localizing.Localize(test::FlowAt(i, 10 + i));
  }
  EXPECT_EQ(answer.journey(), kJourney);
  EXPECT_NEAR(static_cast<double>(answer.step()), 21, 3);
  for (int place = 30; place < 60; ++place) {
    recording.Record(test::FlowAt(place));
  }
  for (int i = 12; i < 40; ++i) {
    answer = localizing.Localize(test::FlowAt(i, 10 + i));
  }
  EXPECT_EQ(answer.sequence(), 39);
  EXPECT_NEAR(static_cast<double>(answer.step()), 49, 3);
  EXPECT_EQ(answer.direction(), v1::DIRECTION_OUTWARD);
  ASSERT_GT(answer.matches_size(), 0);
  EXPECT_EQ(answer.matches(0).step(), 49);
  EXPECT_DOUBLE_EQ(answer.matches(0).p_t(), 1);
  EXPECT_THAT(localizing.Close(), IsGrpcOk());
  EXPECT_THAT(recording.Close(), IsGrpcOk());
}

TEST_F(LifecycleTest, FramesAndTheFlowVectorsOfThemGiveTheSameFileByteForByte) {
  constexpr int kFrames = 10;
  ASSERT_THAT(Create("flow"), IsGrpcOk());
  Recording frames(journeys_.get(), kJourney);
  Recording vectors(journeys_.get(), "robots/r/journeys/flow");
  ObservationFlow flow((FlowOptions()));
  for (int i = 0; i < kFrames; ++i) {
    const std::string left = test::WallAt(i, Side::kLeft);
    const std::string right = test::WallAt(kFrames - i, Side::kRight);
    const Observation observation = FramesAt(i, left, right);
    frames.Record(observation);
    const auto computed = flow.Compute(observation);
    ASSERT_THAT(computed, IsOk());
    if (i > 0) {
      // On the robot a step has the time of its later frame.
      Observation sent;
      sent.sequence = i - 1;
      sent.frame = i;
      sent.capture_time_ns = observation.capture_time_ns;
      sent.views = {*computed->fields[0], *computed->fields[1]};
      vectors.Record(sent);
    }
  }
  EXPECT_THAT(frames.Close(), IsGrpcOk());
  EXPECT_THAT(vectors.Close(), IsGrpcOk());
  v1::ListLandmarksRequest request;
  request.set_include_fingerprints(true);
  std::vector<std::string> lists;
  for (const char* name : {kJourney, "robots/r/journeys/flow"}) {
    grpc::ClientContext context;
    request.set_parent(name);
    v1::ListLandmarksResponse response;
    ASSERT_THAT(journeys_->ListLandmarks(&context, request, &response), IsGrpcOk());
    EXPECT_GT(response.landmarks_size(), 1);
    lists.push_back(response.SerializeAsString());
  }
  EXPECT_EQ(lists[0], lists[1]);
  EXPECT_EQ(Export(), Export("robots/r/journeys/flow"));
}

TEST_F(LifecycleTest, AfterARestartTheRecordingContinuesToTheSameFile) {
  constexpr int kFrames = 14;
  ASSERT_THAT(Create("whole"), IsGrpcOk());
  {
    Recording whole(journeys_.get(), "robots/r/journeys/whole");
    for (int i = 0; i < kFrames; ++i) {
      whole.Record(FramesAt(i, test::WallAt(i, Side::kLeft), test::WallAt(40 - i, Side::kRight)));
    }
    ASSERT_THAT(whole.Close(), IsGrpcOk());
  }
  int next = 0;
  while (next < kFrames) {
    StartServer();
    Recording recording(journeys_.get(), kJourney);
    v1::RecordJourneyResponse first;
    ASSERT_TRUE(recording.Read(&first));
    EXPECT_EQ(first.next_sequence(), next);
    EXPECT_EQ(first.resend_from(), std::max(0, next - 1));
    const int until = std::min(kFrames, next + 4);
    for (int i = static_cast<int>(first.resend_from()); i < until; ++i) {
      next = static_cast<int>(
          recording
              .Record(FramesAt(i, test::WallAt(i, Side::kLeft), test::WallAt(40 - i, Side::kRight)))
              .next_sequence());
    }
  }
  EXPECT_EQ(Export(), Export("robots/r/journeys/whole"));
}

TEST_F(LifecycleTest, ADrainingServerEndsStreamsAsUnavailableAndKeepsAcknowledgedSteps) {
  const std::string address = server_->address();
  ASSERT_THAT(CheckHealth(address), IsOk());
  Recording recording(journeys_.get(), kJourney);
  recording.Record(test::FlowAt(0));
  Localizing localizing(homing_.get(), LocalizeOn(kJourney));
  localizing.Localize(test::FlowAt(0));
  for (int i = 1; i < 6; ++i) {
    recording.Send(test::FlowAt(i));
  }
  std::thread drain([this] { server_->Drain(); });
  const grpc::Status status = recording.AwaitEnd();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("shutting down")));
  EXPECT_TRUE(HasRetryInfo(status));
  EXPECT_EQ(ReasonOf(status), "DRAINING");
  EXPECT_THAT(localizing.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("shutting down")));
  drain.join();
  EXPECT_THAT(CheckHealth(address), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("")));
  StartServer();
  EXPECT_GE(Get().next_sequence(), recording.answers().back().next_sequence());
}

TEST_F(LifecycleTest, ManyStreamsAtOnceEachKeepTheirOrder) {
  constexpr int kStreams = 12;
  constexpr int kPlaces = 40;
  std::vector<std::thread> threads;
  for (int s = 0; s < kStreams; ++s) {
    ASSERT_THAT(Create("j" + std::to_string(s)), IsGrpcOk());
  }
  for (int s = 0; s < kStreams; ++s) {
    threads.emplace_back([this, s] {
      const std::string name = "robots/r/journeys/j" + std::to_string(s);
      Recording recording(journeys_.get(), name);
      // All sent before any answer is read: the server holds back, and loses nothing.
      for (int place = 0; place < kPlaces; ++place) {
        EXPECT_TRUE(recording.Send(test::FlowAt(place)));
      }
      EXPECT_THAT(recording.Close(), IsGrpcOk());
      ASSERT_EQ(recording.answers().size(), std::size_t{kPlaces} + 1);
      for (int i = 0; i < kPlaces; ++i) {
        EXPECT_EQ(recording.answers()[static_cast<std::size_t>(i) + 1].sequence(), i);
      }
      Localizing localizing(homing_.get(), LocalizeOn("robots/r/journeys/-"));
      for (int i = 0; i < 5; ++i) {
        localizing.Localize(test::FlowAt(i));
      }
      EXPECT_THAT(localizing.Close(), IsGrpcOk());
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const std::string file = Export("robots/r/journeys/j0");
  for (int s = 1; s < kStreams; ++s) {
    EXPECT_EQ(Export("robots/r/journeys/j" + std::to_string(s)), file);
  }
}

TEST_F(LifecycleTest, AStreamThatTookItsTimeMaySendManyAtOnce) {
  Recording recording(journeys_.get(), kJourney);
  constexpr int kSlow = 4;
  constexpr int kPlaces = 40;
  // Each awaited for long: the next is asked for only after the answer.
  for (int place = 0; place < kSlow; ++place) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(recording.Record(test::FlowAt(place)).sequence(), place);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  for (int place = kSlow; place < kPlaces; ++place) {
    EXPECT_TRUE(recording.Send(test::FlowAt(place)));
  }
  EXPECT_THAT(recording.Close(), IsGrpcOk());
  ASSERT_EQ(recording.answers().size(), std::size_t{kPlaces} + 1);
  for (int i = 0; i < kPlaces; ++i) {
    EXPECT_EQ(recording.answers()[static_cast<std::size_t>(i) + 1].sequence(), i);
  }
}

TEST_F(LifecycleTest, ASecondServerOnTheSameAddressFailsToStart) {
  ServerOptions options;
  options.listen = server_->address();
  options.database = "sqlite:" + folder_.File("other.db");
  EXPECT_THAT(HomingServer::Start(options),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("in use")));
}

}  // namespace
}  // namespace homing::server
