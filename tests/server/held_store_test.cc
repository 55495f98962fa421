// A store that does not answer, on a server with one worker: the worker stays free for robots whose
// maps are in memory.
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"
#include "homing/v1/fleet_service.grpc.pb.h"
#include "server/rpc/service_core.h"
#include "server/service/fleet_service.h"
#include "server/service/homing_service.h"
#include "server/service/journey_service.h"
#include "tests/server/server_fixture.h"
#include "tests/support/forwarding_store.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

constexpr char kOther[] = "robots/r/journeys/other";
constexpr int kQuotaEvery = 256;

// Between Hold and Release, the chosen reads do not return.
class HeldStore final : public storage::ForwardingStore {
 public:
  enum class Read { kNone, kMap, kList };

  explicit HeldStore(std::unique_ptr<storage::JourneyStore> store)
      : ForwardingStore(store.get()), owned_(std::move(store)) {}

  void Hold(Read read) {
    const MutexLock lock(mutex_);
    held_ = read;
  }
  void Release() {
    Hold(Read::kNone);
    changed_.NotifyAll();
  }
  // Waits until a call is held.
  void AwaitCall() {
    MutexLock lock(mutex_);
    while (calls_ == 0) changed_.Wait(mutex_);
  }

  std::atomic<int> lists = 0;

  absl::StatusOr<JourneyMap> LoadMap(const std::string& name) override {
    Await(Read::kMap);
    return store_->LoadMap(name);
  }
  absl::StatusOr<std::vector<storage::JourneyRecord>> ListJourneys(const std::string& prefix,
                                                                   const std::string& after,
                                                                   int limit) override {
    ++lists;
    Await(Read::kList);
    return store_->ListJourneys(prefix, after, limit);
  }

 private:
  void Await(Read read) {
    MutexLock lock(mutex_);
    if (held_ != read) return;
    ++calls_;
    changed_.NotifyAll();
    while (held_ == read) changed_.Wait(mutex_);
    --calls_;
  }

  const std::unique_ptr<storage::JourneyStore> owned_;
  Mutex mutex_;
  ConditionVariable changed_;
  Read held_ HOMING_GUARDED_BY(mutex_) = Read::kNone;
  int calls_ HOMING_GUARDED_BY(mutex_) = 0;
};

// Too large to be handled on the thread that read it.
Observation LargeAt(int place) {
  constexpr std::size_t kVectors = 3000;
  Observation observation = test::FlowAt(place);
  for (CameraView& view : observation.views) {
    std::vector<FlowVector>& vectors = std::get<FlowField>(view).vectors;
    for (std::size_t i = 0; vectors.size() < kVectors; ++i) vectors.push_back(vectors[i]);
  }
  return observation;
}

class HeldStoreTest : public ::testing::Test {
 protected:
  HeldStoreTest() {
    grpc::ServerBuilder builder;
    for (grpc::Service* service : std::initializer_list<grpc::Service*>{
             &journey_service_, &homing_service_, &fleet_service_}) {
      builder.RegisterService(service);
    }
    server_ = builder.BuildAndStart();
    const auto channel = server_->InProcessChannel({});
    journeys_ = v1::JourneyService::NewStub(channel);
    homing_ = v1::HomingService::NewStub(channel);
    fleet_ = v1::FleetService::NewStub(channel);
    Record("out");
    Record("other");
  }
  ~HeldStoreTest() override {
    server_->Shutdown();
    server_->Wait();
    core_.streams.AwaitNone();
  }

  void Record(const std::string& id) {
    grpc::ClientContext context;
    v1::CreateJourneyRequest request;
    request.set_parent("robots/r");
    request.set_journey_id(id);
    request.set_writer_id(kWriter);
    v1::Journey made;
    ASSERT_THAT(journeys_->CreateJourney(&context, request, &made), IsGrpcOk());
    Recording recording(journeys_.get(), made.name());
    for (int place = 0; place < 10; ++place) recording.Record(test::FlowAt(place));
    ASSERT_THAT(recording.Close(), IsGrpcOk());
  }

  // A robot that needs the worker gets its answer while `call` waits for the store.
  void ExpectFreeWorkerDuring(HeldStore::Read read, const std::function<void()>& call) {
    Localizing home(homing_.get(), LocalizeOn(kJourney));
    home.Localize(test::FlowAt(0));
    held_->Hold(read);
    const auto waiting = std::async(std::launch::async, call);
    held_->AwaitCall();
    const auto answer =
        std::async(std::launch::async, [&] { return home.Localize(LargeAt(1)).sequence(); });
    EXPECT_EQ(answer.wait_for(std::chrono::seconds(20)), std::future_status::ready);
    held_->Release();
  }

  static CoreOptions Options() {
    CoreOptions options;
    options.workers = 1;
    options.limits.max_robot_bytes = std::int64_t{1} << 40;
    return options;
  }

  TemporaryFolder folder_;
  HeldStore* const held_ = new HeldStore(*storage::OpenJourneyStore({.url = folder_.Database()}));
  ServiceCore core_{std::unique_ptr<storage::JourneyStore>(held_), *AccessControl::Open({}),
                    Options()};
  JourneyServiceHandler journey_service_{&core_};
  HomingServiceHandler homing_service_{&core_};
  FleetServiceHandler fleet_service_{&core_};
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::JourneyService::Stub> journeys_;
  std::unique_ptr<v1::HomingService::Stub> homing_;
  std::unique_ptr<v1::FleetService::Stub> fleet_;
};

TEST_F(HeldStoreTest, ARobotOnAWildcardLoadsItsMaps) {
  ExpectFreeWorkerDuring(HeldStore::Read::kMap, [this] {
    Localizing lost(homing_.get(), LocalizeOn("robots/r/journeys/-"));
    EXPECT_EQ(lost.Localize(LargeAt(0)).sequence(), 0);
  });
}

TEST_F(HeldStoreTest, AQueryLoadsItsMap) {
  ExpectFreeWorkerDuring(HeldStore::Read::kMap, [this] {
    grpc::ClientContext context;
    v1::MatchLandmarksRequest request;
    request.set_journey(kOther);
    request.mutable_left()->mutable_fingerprints()->add_fingerprints()->set_count(1);
    v1::MatchLandmarksResponse response;
    EXPECT_THAT(homing_->MatchLandmarks(&context, request, &response), IsGrpcOk());
  });
}

TEST_F(HeldStoreTest, ARecordingChecksItsQuota) {
  Recording recording(journeys_.get(), kOther);
  for (int place = 10; place < 10 + kQuotaEvery - 1; ++place) recording.Record(test::FlowAt(place));
  ExpectFreeWorkerDuring(HeldStore::Read::kList, [&] {
    Observation last = LargeAt(10);
    last.sequence = 10 + kQuotaEvery - 1;
    EXPECT_EQ(recording.Record(last).sequence(), last.sequence);
  });
}

TEST_F(HeldStoreTest, AnOperatorListsAndWatchesTheFleet) {
  ExpectFreeWorkerDuring(HeldStore::Read::kList, [this] {
    grpc::ClientContext context;
    v1::ListRobotsResponse response;
    EXPECT_THAT(fleet_->ListRobots(&context, {}, &response), IsGrpcOk());
    EXPECT_EQ(response.robots_size(), 1);
  });
  ExpectFreeWorkerDuring(HeldStore::Read::kList, [this] {
    grpc::ClientContext context;
    const auto stream = fleet_->WatchFleet(&context, {});
    v1::WatchFleetResponse response;
    EXPECT_TRUE(stream->Read(&response));
    context.TryCancel();
    stream->Finish();
  });
}

TEST_F(HeldStoreTest, CallersAtTheSameTimeShareACountOfTheJourneys) {
  held_->Hold(HeldStore::Read::kList);
  const int before = held_->lists;
  std::vector<std::future<void>> calls;
  for (int i = 0; i < ServiceCore::kStoreReaders; ++i) {
    calls.push_back(std::async(std::launch::async, [this] {
      grpc::ClientContext context;
      v1::ListRobotsResponse response;
      EXPECT_THAT(fleet_->ListRobots(&context, {}, &response), IsGrpcOk());
      EXPECT_EQ(response.robots_size(), 1);
    }));
  }
  held_->AwaitCall();
  // The others wait for the lock by then.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  held_->Release();
  for (auto& call : calls) call.get();
  EXPECT_LE(held_->lists - before, 2);
}

}  // namespace
}  // namespace homing::server
