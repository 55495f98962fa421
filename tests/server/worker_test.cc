// Long work on a server with one worker: others do not wait for it.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include "homing/image/frame.h"
#include "proto/wire/observation_conversion.h"
#include "storage/connection.h"
#include "tests/server/server_fixture.h"
#include "tests/support/journey_file.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class WorkerTest : public ServerTest {
 protected:
  WorkerTest() { options_.workers = 1; }
  void SetUp() override {
    StartServer();
    ASSERT_THAT(Create(), IsGrpcOk());
  }
  static double SecondsOf(const std::function<void()>& call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  // A query of two frames whose comparison keeps a worker busy.
  v1::MatchLandmarksRequest CostlyQuery(int side_px);
  // A query of one fingerprint: the one worker answers it as soon as it is free.
  void CallWorker() {
    grpc::ClientContext context;
    v1::MatchLandmarksRequest request;
    request.set_journey(kJourney);
    request.mutable_left()->mutable_fingerprints()->add_fingerprints()->set_count(1);
    v1::MatchLandmarksResponse response;
    EXPECT_THAT(homing_->MatchLandmarks(&context, request, &response), IsGrpcOk());
  }
};

// Of noise, in which nothing is found: the most work that two frames can make.
std::string NoiseOf(std::uint32_t seed, int width, int height) {
  std::string bytes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(255 * test::Noise(seed, static_cast<std::uint32_t>(i)));
  }
  return bytes;
}

v1::MatchLandmarksRequest WorkerTest::CostlyQuery(int side_px) {
  const std::string first = NoiseOf(1, side_px, side_px);
  const std::string second = NoiseOf(2, side_px, side_px);
  v1::CreateJourneyRequest journey;
  journey.set_parent("robots/r");
  journey.set_journey_id("costly");
  v1::FlowSettings* flow = journey.mutable_journey()->mutable_settings()->mutable_flow();
  flow->set_working_width_px(std::min(2 * side_px, 2048));
  flow->set_window_px(63);
  flow->set_cell_px(16);
  flow->set_min_eigenvalue(1e-6);
  flow->set_smoothing_sigma_px(1);
  flow->set_normalization_window_px(45);
  flow->set_normalization_floor(1);
  flow->set_pyramid_levels(6);
  flow->set_max_forward_backward_px(5);
  v1::Journey made;
  grpc::ClientContext creating;
  EXPECT_THAT(journeys_->CreateJourney(&creating, journey, &made), IsGrpcOk());
  v1::MatchLandmarksRequest request;
  request.set_journey(made.name());
  request.set_travel(v1::TRAVEL_SAME);
  v1::FramePair* pair = request.mutable_left()->mutable_frames();
  *pair->mutable_first() = wire::ToProto(test::GrayFrame(first, side_px, side_px));
  *pair->mutable_second() = wire::ToProto(test::GrayFrame(second, side_px, side_px));
  return request;
}

TEST_F(WorkerTest, ACallerDoesNotWaitForAllCallsOfAnother) {
  constexpr std::size_t kCalls = 12;
  const v1::MatchLandmarksRequest request = CostlyQuery(400);
  grpc::ChannelArguments own_connection;
  own_connection.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::HomingService::NewStub(grpc::CreateCustomChannel(
      server_->address(), grpc::InsecureChannelCredentials(), own_connection));
  std::atomic<std::size_t> ended = 0;
  std::vector<std::future<void>> calls;
  for (std::size_t i = 0; i < kCalls; ++i) {
    calls.push_back(std::async(std::launch::async, [&] {
      grpc::ClientContext context;
      v1::MatchLandmarksResponse response;
      EXPECT_THAT(stub->MatchLandmarks(&context, request, &response), IsGrpcOk());
      ++ended;
    }));
  }
  // Now the others wait.
  while (ended < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CallWorker();
  EXPECT_LT(ended, kCalls - 5);
  for (auto& call : calls) call.wait();
}

TEST_F(WorkerTest, TheRequestsOfACallerThatWaitHaveAPartOfTheMemory) {
  options_.limits.memory_quota = 40 << 20;
  StartServer();
  // Four of 2 MiB fit into the caller's quarter.
  const v1::MatchLandmarksRequest request = CostlyQuery(1024);
  std::vector<std::future<grpc::Status>> calls;
  for (int i = 0; i < 10; ++i) {
    calls.push_back(std::async(std::launch::async, [&] {
      grpc::ClientContext context;
      v1::MatchLandmarksResponse response;
      return homing_->MatchLandmarks(&context, request, &response);
    }));
  }
  int taken = 0;
  for (auto& call : calls) {
    const grpc::Status status = call.get();
    taken += status.ok() ? 1 : 0;
    EXPECT_EQ(ReasonOf(status), status.ok() ? "" : "REQUEST_MEMORY");
  }
  EXPECT_GE(taken, 1);
  EXPECT_LT(taken, 10);
  CallWorker();
}

TEST_F(WorkerTest, AFramePairOfAClientThatDoesNotWaitFreesItsWorker) {
  const v1::MatchLandmarksRequest request = CostlyQuery(1024);
  const auto match = [&](std::chrono::milliseconds timeout) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + timeout);
    v1::MatchLandmarksResponse response;
    return homing_->MatchLandmarks(&context, request, &response);
  };
  const double whole = SecondsOf([&] { EXPECT_THAT(match(std::chrono::minutes(5)), IsGrpcOk()); });
  const auto part = std::chrono::milliseconds(static_cast<int>(250 * whole));
  EXPECT_THAT(match(part), GrpcStatusIs(grpc::StatusCode::DEADLINE_EXCEEDED, HasSubstr("")));
  // The one worker is free.
  EXPECT_LT(SecondsOf([&] { CallWorker(); }), 0.4 * whole);
}

TEST_F(WorkerTest, LargeImagesHoldUpNobodyWithUsualOnes) {
  const v1::MatchLandmarksRequest request = CostlyQuery(1200);
  const auto match = [&] {
    grpc::ClientContext context;
    v1::MatchLandmarksResponse response;
    EXPECT_THAT(homing_->MatchLandmarks(&context, request, &response), IsGrpcOk());
  };
  const double whole = SecondsOf(match);
  const auto running = std::async(std::launch::async, match);
  std::this_thread::sleep_for(std::chrono::duration<double>(0.1 * whole));
  EXPECT_LT(SecondsOf([&] { CallWorker(); }), 0.3 * whole);
}

TEST_F(WorkerTest, TheAnalysisOfARouteThatRepeatsItselfHoldsUpNobody) {
  Recording recording(journeys_.get(), kJourney);
  for (int step = 0; step < 300; ++step) recording.Send(test::FlowAt(step, step % 40));
  ASSERT_THAT(recording.Close(), IsGrpcOk());
  const auto analyze = [&] {
    grpc::ClientContext context;
    v1::AnalyzeAliasingRequest request;
    request.set_name(kJourney);
    v1::AnalyzeAliasingResponse report;
    EXPECT_THAT(journeys_->AnalyzeAliasing(&context, request, &report), IsGrpcOk());
  };
  const double whole = SecondsOf(analyze);
  const auto analysis = std::async(std::launch::async, analyze);
  std::this_thread::sleep_for(std::chrono::duration<double>(0.1 * whole));
  EXPECT_LT(SecondsOf([&] { CallWorker(); }), 0.3 * whole);
}

TEST_F(WorkerTest, AQueryOfManyFingerprintsHoldsUpNobodyAndEndsWhenNobodyWaits) {
  constexpr char kLong[] = "robots/r/journeys/long";
  ASSERT_THAT(Import(kLong, test::JourneyFile(60'000, 2), 1 << 20), IsGrpcOk());
  const v1::MatchLandmarksRequest request = test::ManyFingerprints(kLong);
  const auto match = [&](std::chrono::duration<double> most) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() +
                         std::chrono::duration_cast<std::chrono::milliseconds>(most));
    v1::MatchLandmarksResponse response;
    return homing_->MatchLandmarks(&context, request, &response);
  };
  const double whole = SecondsOf([&] { EXPECT_THAT(match(std::chrono::minutes(5)), IsGrpcOk()); });
  const auto running = std::async(std::launch::async, match, std::chrono::minutes(5));
  std::this_thread::sleep_for(std::chrono::duration<double>(0.1 * whole));
  EXPECT_LT(SecondsOf([&] { CallWorker(); }), 0.4 * whole);
  running.wait();
  EXPECT_THAT(match(std::chrono::duration<double>(0.1 * whole)),
              GrpcStatusIs(grpc::StatusCode::DEADLINE_EXCEEDED, HasSubstr("")));
  EXPECT_LT(SecondsOf([&] { StartServer(); }), 0.5 * whole);
}

TEST_F(WorkerTest, RobotsGoHomeWhileTheStoreAcceptsNoWrites) {
  RecordFlow(0, 30);
  Localizing home(homing_.get(), LocalizeOn(kJourney));
  home.Localize(test::FlowAt(0));
  const auto locking = storage::Connection::Open(
      folder_.File("homing.db"), storage::Connection::Access::kReadWrite, /*busy_timeout_ms=*/1000);
  ASSERT_THAT(locking, IsOk());
  std::vector<std::future<grpc::Status>> creations;
  const auto locked = (*locking)->Write([&] {
    for (const char* journey : {"a", "b", "c"}) {
      creations.push_back(
          std::async(std::launch::async, [this, journey] { return Create(journey); }));
    }
    Recording claim(journeys_.get(), kJourney);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_LT(SecondsOf([&] {
                EXPECT_EQ(home.Localize(test::FlowAt(1)).sequence(), 1);
                Localizing another(homing_.get(), LocalizeOn(kJourney));
                EXPECT_EQ(another.Localize(test::FlowAt(0)).sequence(), 0);
                Get();
              }),
              1.5);
    return absl::OkStatus();
  });
  EXPECT_THAT(locked, IsOk());
  for (auto& creation : creations) EXPECT_THAT(creation.get(), IsGrpcOk());
}

TEST_F(WorkerTest, AnAnalysisThatNobodyWaitsForEnds) {
  Recording recording(journeys_.get(), kJourney);
  for (int step = 0; step < 300; ++step) recording.Send(test::FlowAt(step, step % 40));
  ASSERT_THAT(recording.Close(), IsGrpcOk());
  const auto analyze = [&](std::chrono::duration<double> most) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() +
                         std::chrono::duration_cast<std::chrono::milliseconds>(most));
    v1::AnalyzeAliasingRequest request;
    request.set_name(kJourney);
    v1::AnalyzeAliasingResponse report;
    return journeys_->AnalyzeAliasing(&context, request, &report);
  };
  const double whole =
      SecondsOf([&] { EXPECT_THAT(analyze(std::chrono::minutes(5)), IsGrpcOk()); });
  EXPECT_THAT(analyze(std::chrono::duration<double>(0.1 * whole)),
              GrpcStatusIs(grpc::StatusCode::DEADLINE_EXCEEDED, HasSubstr("")));
  EXPECT_LT(SecondsOf([&] { StartServer(); }), 0.5 * whole);
}

}  // namespace
}  // namespace homing::server
