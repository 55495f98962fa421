// Clients that open calls and do not read.
#include <grpcpp/generic/generic_stub.h>

#include <filesystem>
#include <iterator>
#include <thread>

#include "tests/server/server_fixture.h"
#include "tests/support/journey_file.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

// A client that sends calls and does not read the answers: HTTP/2 then holds them back.
class DeafClient {
 public:
  explicit DeafClient(const std::string& address)
      : stub_(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())) {}
  ~DeafClient() {
    for (const auto& context : contexts_) context->TryCancel();
    calls_.clear();
    queue_.Shutdown();
    while (queue_.Next(&tag_, &ok_)) {
    }
  }

  // Sends no request.
  void Open(const std::string& method) {
    contexts_.push_back(std::make_unique<grpc::ClientContext>());
    calls_.push_back(stub_.PrepareCall(contexts_.back().get(), method, &queue_));
    calls_.back()->StartCall(nullptr);
    Await();
  }
  void Call(const std::string& method, const google::protobuf::Message& request) {
    Open(method);
    const grpc::Slice slice(request.SerializeAsString());
    calls_.back()->WriteLast(grpc::ByteBuffer(&slice, 1), grpc::WriteOptions(), nullptr);
    Await();
  }

 private:
  void Await() { queue_.Next(&tag_, &ok_); }

  grpc::GenericStub stub_;
  grpc::CompletionQueue queue_;
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts_;
  std::vector<std::unique_ptr<grpc::GenericClientAsyncReaderWriter>> calls_;
  void* tag_ = nullptr;
  bool ok_ = false;
};

class DeafClientTest : public ServerTest {};

// Before any identity is shown.
TEST_F(DeafClientTest, StreamsOfReflectionTakeFewThreads) {
  const auto threads = [] {
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    return std::distance(begin(tasks), end(tasks));
  };
  DeafClient client(server_->address());
  const auto before = threads();
  for (int i = 0; i < 200; ++i) {
    client.Open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo");
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_LT(threads(), before + 64);
  EXPECT_THAT(Create(), IsGrpcOk());
}

TEST_F(DeafClientTest, AnswersThatNobodyReadsShareTheMemory) {
  options_.limits.memory_quota = 64 << 20;
  StartServer();
  ASSERT_THAT(Import("robots/r/journeys/large", test::JourneyFile(200'000, 2), 1 << 20),
              IsGrpcOk());
  v1::ListLandmarksRequest request;
  request.set_parent("robots/r/journeys/large");
  request.set_include_fingerprints(true);
  // An answer of some MiB; others may need only part of the memory.
  const auto list = [&] {
    grpc::ClientContext context;
    v1::ListLandmarksResponse response;
    const grpc::Status status = journeys_->ListLandmarks(&context, request, &response);
    // More than the client accepts: it was sent.
    const bool sent = status.ok() || status.error_message().find("larger than max") < 100;
    return sent ? grpc::Status::OK : status;
  };
  EXPECT_THAT(list(), IsGrpcOk());
  {
    DeafClient deaf(server_->address());
    for (int i = 0; i < 10; ++i) deaf.Call("/homing.v1.JourneyService/ListLandmarks", request);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    grpc::Status status;
    while (status.ok() && std::chrono::steady_clock::now() < end) status = list();
    EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("")));
    EXPECT_EQ(ReasonOf(status), "ANSWER_MEMORY");
    EXPECT_TRUE(HasRetryInfo(status));
    EXPECT_THAT(server_->MetricsText(), HasSubstr("reason=\"ANSWER_MEMORY\"} "));
    EXPECT_THAT(Create(), IsGrpcOk());
  }
  // The server sees the cancellation a moment later; a test that hangs is ended by the runner.
  while (!list().ok()) {
  }
}

}  // namespace
}  // namespace homing::server
