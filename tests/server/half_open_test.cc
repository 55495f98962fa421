// Calls whose request does not arrive, over a real socket.
#include <grpcpp/generic/generic_stub.h>

#include <future>
#include <list>
#include <optional>

#include "server/access/token_book.h"
#include "server/rpc/service_core.h"
#include "tests/server/server_fixture.h"
#include "tests/support/connected.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

constexpr char kGet[] = "/homing.v1.JourneyService/GetJourney";
constexpr char kWatch[] = "/homing.v1.FleetService/WatchRobot";

// Sends the headers of a call. Sends a request only if the test asks for one.
class HalfOpenCall {
 public:
  HalfOpenCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
               const std::string& token = "")
      : stub_(channel) {
    if (!token.empty()) context_.AddMetadata("authorization", "Bearer " + token);
    call_ = stub_.PrepareCall(&context_, method, &queue_);
    call_->StartCall(nullptr);
    AwaitOne(std::chrono::seconds(10));
    call_->Finish(&status_, &status_);
  }
  ~HalfOpenCall() {
    context_.TryCancel();
    queue_.Shutdown();
    void* tag = nullptr;
    bool ok = false;
    while (queue_.Next(&tag, &ok)) {
    }
  }
  HalfOpenCall(const HalfOpenCall&) = delete;
  HalfOpenCall& operator=(const HalfOpenCall&) = delete;

  // The status if the server ends the call within `most`.
  std::optional<grpc::Status> End(std::chrono::milliseconds most) {
    return AwaitOne(most) == &status_ ? std::optional(status_) : std::nullopt;
  }

 private:
  void* AwaitOne(std::chrono::milliseconds most) {
    void* tag = nullptr;
    bool ok = false;
    return queue_.AsyncNext(&tag, &ok, std::chrono::system_clock::now() + most) ==
                   grpc::CompletionQueue::GOT_EVENT
               ? tag
               : nullptr;
  }

  grpc::GenericStub stub_;
  grpc::CompletionQueue queue_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  grpc::Status status_;
};

constexpr std::chrono::seconds kSoon{5};

class HalfOpenTest : public ServerTest {
 protected:
  // Opens `most` calls, which stay, and more until one is refused: the server may see some later.
  static std::optional<grpc::Status> OpenUntilRefused(const std::shared_ptr<grpc::Channel>& channel,
                                                      const char* method, int most,
                                                      std::list<HalfOpenCall>* calls) {
    for (int i = 0; i < most; ++i) calls->emplace_back(channel, method, "secret-r");
    EXPECT_FALSE(calls->back().End(std::chrono::milliseconds(200)));
    std::optional<grpc::Status> refused;
    for (int i = 0; i < 20 && !refused; ++i) {
      calls->emplace_back(channel, method, "secret-r");
      refused = calls->back().End(std::chrono::milliseconds(500));
    }
    return refused;
  }
  void StartGuarded() {
    options_.tokens = folder_.File("tokens.toml");
    for (const char* id : {"r", "s"}) {
      const std::string robot = std::string("robots/") + id;
      EXPECT_THAT(AddToken(options_.tokens, robot, HashToken(std::string("secret-") + id)), IsOk());
    }
    StartServer();
  }
};

TEST_F(HalfOpenTest, ARequestHasAMinuteToArrive) {
  const auto channel = ConnectedChannel(server_->address());
  for (const char* method : {kGet, kWatch}) {
    HalfOpenCall call(channel, method);
    EXPECT_FALSE(call.End(std::chrono::milliseconds(200)));
    std::optional<grpc::Status> status;
    // The server may see the call only now.
    for (int i = 0; i < 50 && !status; ++i) {
      Wait(std::chrono::seconds(61));
      status = call.End(std::chrono::milliseconds(200));
    }
    ASSERT_TRUE(status) << method;
    EXPECT_THAT(*status, GrpcStatusIs(grpc::StatusCode::DEADLINE_EXCEEDED, HasSubstr("60 s")));
    EXPECT_EQ(ReasonOf(*status), "REQUEST_TIME");
  }
}

TEST_F(HalfOpenTest, AStrangersRequestIsNotAwaited) {
  StartGuarded();
  const auto channel = ConnectedChannel(server_->address());
  for (const char* method : {kGet, kWatch, "/homing.v1.JourneyService/ExportJourney",
                             "/homing.v1.HomingService/MatchLandmarks"}) {
    HalfOpenCall call(channel, method, "guess");
    const auto status = call.End(kSoon);
    ASSERT_TRUE(status) << method;
    EXPECT_EQ(status->error_code(), grpc::StatusCode::UNAUTHENTICATED) << method;
  }
}

TEST_F(HalfOpenTest, ACallerHasFewRequestsOnTheirWayAndOthersGoOn) {
  StartGuarded();
  const auto channel = ConnectedChannel(server_->address());
  std::list<HalfOpenCall> calls;
  const auto status = OpenUntilRefused(channel, kGet, ServiceCore::kMaxUnreadOfCaller, &calls);
  ASSERT_TRUE(status);
  EXPECT_EQ(ReasonOf(*status), "UNREAD");
  EXPECT_TRUE(HasRetryInfo(*status));
  EXPECT_FALSE(HalfOpenCall(channel, kGet, "secret-s").End(std::chrono::milliseconds(200)));
}

TEST_F(HalfOpenTest, ACallerHasFewWatches) {
  StartGuarded();
  const auto channel = ConnectedChannel(server_->address());
  std::list<HalfOpenCall> watches;
  const auto status = OpenUntilRefused(channel, kWatch, ServiceCore::kMaxWatchesOfCaller, &watches);
  ASSERT_TRUE(status);
  EXPECT_THAT(*status, GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("256")));
  EXPECT_EQ(ReasonOf(*status), "WATCHES");
}

TEST_F(HalfOpenTest, AnImportThatEndsMidwaySaysWhy) {
  grpc::ClientContext context;
  v1::ImportJourneyResponse response;
  const auto stream = journeys_->ImportJourney(&context, &response);
  v1::ImportJourneyRequest request;
  request.set_name("robots/r/journeys/copy");
  ASSERT_TRUE(stream->Write(request));
  auto end = std::async(std::launch::async, [&] { return stream->Finish(); });
  // The server may read the message only now.
  while (end.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready) {
    Wait(std::chrono::seconds(options_.limits.idle_stream_s + 1));
  }
  const grpc::Status status = end.get();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("idle")));
  EXPECT_EQ(ReasonOf(status), "IDLE");
}

TEST_F(HalfOpenTest, ADrainingServerDoesNotWaitForRequests) {
  options_.drain_ms = 60'000;
  StartServer();
  HalfOpenCall call(ConnectedChannel(server_->address()), kGet);
  EXPECT_FALSE(call.End(std::chrono::milliseconds(200)));
  server_->Drain();
  const auto status = call.End(kSoon);
  ASSERT_TRUE(status);
  EXPECT_EQ(ReasonOf(*status), "DRAINING");
}

}  // namespace
}  // namespace homing::server
