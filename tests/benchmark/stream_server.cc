#include "tests/benchmark/stream_server.h"

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <thread>

#include "absl/strings/str_cat.h"
#include "homing/v1/journey_service.pb.h"
#include "server/homing_server.h"
#include "server/rpc/api_service.h"
#include "server/rpc/bidi_stream.h"
#include "server/tls_credentials.h"
#include "tests/support/temporary_folder.h"

namespace homing::benchmarks {
namespace {

class Homing final : public StreamServer {
 public:
  bool Start() {
    server::ServerOptions options;
    options.listen = "127.0.0.1:0";
    options.database = folder_.Database();
    auto server = server::HomingServer::Start(options);
    if (server.ok()) server_ = std::move(*server);
    return server_ != nullptr;
  }
  std::string address() const override { return server_->address(); }

 private:
  const TemporaryFolder folder_;
  std::unique_ptr<server::HomingServer> server_;
};

class EchoStream final
    : public server::BidiStream<v1::RecordJourneyRequest, v1::RecordJourneyResponse> {
 public:
  EchoStream(server::ServiceCore* core, grpc::CallbackServerContext* context)
      : BidiStream(core, context, server::Rpc::kRecordJourney) {}

 protected:
  server::WorkerPool* OtherPoolOf(const v1::RecordJourneyRequest& /*request*/) override {
    return nullptr;
  }
  absl::Status Handle(const v1::RecordJourneyRequest& request) override {
    Answer([&request](v1::RecordJourneyResponse* response) {
      if (request.has_observation()) {
        response->set_sequence(request.observation().sequence());
        response->set_next_sequence(request.observation().sequence() + 1);
      }
    });
    return absl::OkStatus();
  }
};

class EchoService final : public server::ApiService {
 public:
  explicit EchoService(server::ServiceCore* core) : ApiService(core) {
    AddUnary(server::Rpc::kCreateJourney, &EchoService::CreateJourney);
    AddStream<EchoStream, v1::RecordJourneyResponse>(server::Rpc::kRecordJourney);
  }

 private:
  void CreateJourney(const server::UnaryCall::Ptr& call,
                     const v1::CreateJourneyRequest* /*request*/, v1::Journey* /*response*/) {
    call->End(absl::OkStatus());
  }
};

server::CoreOptions EchoOptions() {
  server::CoreOptions options;
  options.workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return options;
}

class Echo final : public StreamServer {
 public:
  Echo()
      : core_(*storage::OpenJourneyStore({.url = "sqlite::memory:"}),
              *server::AccessControl::Open({}), EchoOptions()),
        service_(&core_) {}
  ~Echo() override {
    if (server_ == nullptr) return;
    server_->Shutdown();
    server_->Wait();
    core_.streams.AwaitNone();
  }
  bool Start(const EchoTls& tls) {
    server::ServerOptions options;
    options.tls_cert = tls.cert;
    options.tls_key = tls.key;
    if (!tls.cert.empty()) {
      auto opened = server::TlsFiles::Open(tls.cert, tls.key, "");
      if (!opened.ok()) return false;
      tls_files_ = *std::move(opened);
    }
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0",
                             server::MakeServerCredentials(options, tls_files_.get(), core_.access),
                             &port_);
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
    return server_ != nullptr;
  }
  std::string address() const override { return absl::StrCat("127.0.0.1:", port_); }

 private:
  server::ServiceCore core_;
  EchoService service_;
  // Null: plain text.
  std::unique_ptr<server::TlsFiles> tls_files_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace

std::unique_ptr<StreamServer> StartHomingServer() {
  auto server = std::make_unique<Homing>();
  return server->Start() ? std::move(server) : nullptr;
}

std::unique_ptr<StreamServer> StartEchoServer(const EchoTls& tls) {
  auto server = std::make_unique<Echo>();
  return server->Start(tls) ? std::move(server) : nullptr;
}

}  // namespace homing::benchmarks
