// Requests through their handlers, over a real connection: parsing, admission, session, store,
// answer. Input: the RPC, then its messages, each after its length (two bytes).
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>

#include "absl/strings/match.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "proto/wire/observation_conversion.h"
#include "server/access/rpc.h"
#include "server/homing_server.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/route.h"

namespace homing::fuzz {
namespace {

// Stored data ends with the server.
constexpr int kInputsAServer = 1000;
constexpr std::size_t kMostMessages = 32;

class Server {
 public:
  Server() {
    server::ServerOptions options;
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
    options.listen = "unix:" + folder_ + "/server.sock";
    options.database = "sqlite:" + folder_ + "/homing.db";
    options.max_pixels = 1 << 18;
    options.workers = 1;
    auto server = server::HomingServer::Start(options);
    Require(server.ok());
    server_ = *std::move(server);
    channel_ = grpc::CreateChannel(options.listen, grpc::InsecureChannelCredentials());
    Record("a");
    Record("b");
  }

  ~Server() {
    server_.reset();
    std::filesystem::remove_all(folder_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }

 private:
  // Twenty steps of robots/r/journeys/{id}.
  void Record(const std::string& id) const {
    const auto stub = v1::JourneyService::NewStub(channel_);
    v1::CreateJourneyRequest create;
    create.set_parent("robots/r");
    create.set_journey_id(id);
    v1::Journey journey;
    grpc::ClientContext creating;
    Require(stub->CreateJourney(&creating, create, &journey).ok());
    grpc::ClientContext recording;
    const auto stream = stub->RecordJourney(&recording);
    v1::RecordJourneyRequest request;
    request.mutable_config()->set_journey("robots/r/journeys/" + id);
    request.mutable_config()->set_writer_id("w");
    stream->Write(request);
    for (int i = 0; i < 20; ++i) {
      *request.mutable_observation() = wire::ToProto(test::FlowAt(i));
      stream->Write(request);
    }
    stream->WritesDone();
    v1::RecordJourneyResponse answer;
    while (stream->Read(&answer)) {
    }
    Require(stream->Finish().ok());
  }

  const std::string folder_ = "/dev/shm/homing_fuzz_" + std::to_string(::getpid());
  std::unique_ptr<server::HomingServer> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

// One call with raw messages, whatever the kind of its method; one step after the other.
class RawCall {
 public:
  RawCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method)
      : stub_(channel) {
    // A watch ends only when its client ends it.
    if (absl::StrContains(method, "/Watch")) {
      context_.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(50));
    }
    call_ = stub_.PrepareCall(&context_, method, &queue_);
    call_->StartCall(this);
    started_ = Next();
  }
  ~RawCall() {
    call_->Finish(&status_, this);
    Next();
    queue_.Shutdown();
    void* tag = nullptr;
    bool ok = false;
    while (queue_.Next(&tag, &ok)) {
    }
  }

  bool Write(std::string_view message) {
    const grpc::Slice slice(message.data(), message.size());
    if (!started_) return false;
    call_->Write(grpc::ByteBuffer(&slice, 1), this);
    return Next();
  }
  void ReadAll() {
    if (!started_) return;
    call_->WritesDone(this);
    Next();
    grpc::ByteBuffer answer;
    do {
      call_->Read(&answer, this);
    } while (Next());
  }

 private:
  bool Next() {
    void* tag = nullptr;
    bool ok = false;
    return queue_.Next(&tag, &ok) && ok;
  }

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  grpc::Status status_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  bool started_ = false;
};

void Run(FuzzInput input) {
  static std::unique_ptr<Server> server;
  static int inputs = 0;
  if (server == nullptr || inputs++ % kInputsAServer == 0) {
    server.reset();
    server = std::make_unique<Server>();
  }
  const auto rpc = input.Take<std::uint8_t>() % server::kRpcs.size();
  RawCall call(server->channel(), "/" + std::string(server::kRpcs[rpc].method));
  for (std::size_t i = 0; i < kMostMessages && !input.empty(); ++i) {
    const auto size = input.Take<std::uint16_t>();
    if (!call.Write(input.TakeBytes(size))) break;
  }
  call.ReadAll();
}

}  // namespace
}  // namespace homing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::Run({data, size});
  return 0;
}
