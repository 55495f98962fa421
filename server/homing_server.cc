#include "server/homing_server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/status_macros.h"
#include "server/deviation_model_service.h"
#include "server/homing_service.h"
#include "server/journey_service.h"
#include "server/store_watch.h"

namespace homing::server {
namespace {

// Robots behind radio links: a dead one is found within half a minute.
constexpr int kKeepaliveMs = 20'000;
constexpr int kKeepaliveTimeoutMs = 10'000;
// Clients may ping as often as this.
constexpr int kMinPingIntervalMs = 5'000;

// The library adds its plugin to every server of a process that links it.
class WithoutReflection : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments* /*arguments*/) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    std::erase_if(*plugins,
                  [](const auto& plugin) { return plugin->name() == "proto_server_reflection"; });
  }
};

absl::StatusOr<std::string> ReadFile(const std::string& flag, const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    return absl::InvalidArgumentError(
        absl::StrCat(flag, " is \"", path, "\"; the file cannot be read"));
  }
  return text.str();
}

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> CredentialsOf(
    const ServerOptions& options) {
  if (options.tls_cert.empty()) {
    return grpc::InsecureServerCredentials();
  }
  grpc::SslServerCredentialsOptions tls;
  grpc::SslServerCredentialsOptions::PemKeyCertPair pair;
  HOMING_ASSIGN_OR_RETURN(pair.cert_chain, ReadFile("tls-cert", options.tls_cert));
  HOMING_ASSIGN_OR_RETURN(pair.private_key, ReadFile("tls-key", options.tls_key));
  tls.pem_key_cert_pairs.push_back(pair);
  if (!options.tls_client_ca.empty()) {
    HOMING_ASSIGN_OR_RETURN(tls.pem_root_certs, ReadFile("tls-client-ca", options.tls_client_ca));
    tls.client_certificate_request = GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY;
  }
  return grpc::SslServerCredentials(tls);
}

CoreOptions CoreOptionsOf(const ServerOptions& options, std::function<TimePoint()> clock) {
  CoreOptions core;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  core.workers = options.workers > 0 ? options.workers : std::max(cores, 1);
  core.decode.max_pixels = options.max_pixels;
  core.wire.max_vectors = options.max_vectors;
  core.catalog.cache_bytes = options.map_cache;
  core.all_journeys_index = options.all_journeys_index;
  if (clock) {
    core.clock = std::move(clock);
  }
  return core;
}

void Configure(const ServerOptions& options, grpc::ServerBuilder* builder) {
  builder->SetMaxReceiveMessageSize(static_cast<int>(options.max_message));
  // A second server on the same port must fail, not share it silently.
  builder->AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  builder->AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                              kMinPingIntervalMs);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  if (options.no_reflection) {
    builder->SetOption(std::make_unique<WithoutReflection>());
  }
}

}  // namespace

struct HomingServer::State {
  State(std::unique_ptr<storage::JourneyStore> store, const CoreOptions& options)
      : core(std::make_unique<ServiceCore>(std::move(store), options)),
        journeys(core.get()),
        homing(core.get()),
        models(core.get()) {}

  absl::Status Listen(const ServerOptions& options);

  // Outlived by nothing but the handlers' last steps: reset when drained.
  std::unique_ptr<ServiceCore> core;
  JourneyServiceHandler journeys;
  HomingServiceHandler homing;
  DeviationModelServiceHandler models;
  std::unique_ptr<grpc::Server> server;
  // Ends before the server whose health it sets.
  std::unique_ptr<StoreWatch> watch;
  std::string address;
  std::chrono::milliseconds drain_time{};
};

absl::Status HomingServer::State::Listen(const ServerOptions& options) {
  HOMING_ASSIGN_OR_RETURN(const auto credentials, CredentialsOf(options));
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  Configure(options, &builder);
  int port = 0;
  builder.AddListeningPort(options.listen, credentials, &port);
  builder.RegisterService(&journeys);
  builder.RegisterService(&homing);
  builder.RegisterService(&models);
  server = builder.BuildAndStart();
  const bool is_socket_file = options.listen.rfind("unix:", 0) == 0;
  if (server == nullptr || (port <= 0 && !is_socket_file)) {
    return absl::UnavailableError(
        absl::StrCat("listen is \"", options.listen,
                     "\"; the address is in use, is not this machine's, or the TLS files are bad"));
  }
  address = is_socket_file
                ? options.listen
                : absl::StrCat(options.listen.substr(0, options.listen.rfind(':')), ":", port);
  drain_time = std::chrono::milliseconds(options.drain_ms);
  watch = std::make_unique<StoreWatch>(core->store.get(), [this](bool well) {
    if (auto* health = server->GetHealthCheckService()) {
      health->SetServingStatus(well);
    }
  });
  return absl::OkStatus();
}

HomingServer::HomingServer(std::unique_ptr<State> state) : state_(std::move(state)) {}

HomingServer::~HomingServer() { Drain(); }

const std::string& HomingServer::address() const { return state_->address; }

absl::StatusOr<std::unique_ptr<HomingServer>> HomingServer::Start(
    const ServerOptions& options, std::function<TimePoint()> clock) {
  HOMING_RETURN_IF_ERROR(Validate(options));
  storage::StoreOptions store_options;
  store_options.url = options.database;
  store_options.read_only = options.readonly;
  HOMING_ASSIGN_OR_RETURN(auto store, storage::OpenJourneyStore(store_options));
  auto state = std::make_unique<State>(std::move(store), CoreOptionsOf(options, std::move(clock)));
  HOMING_RETURN_IF_ERROR(state->Listen(options));
  return std::unique_ptr<HomingServer>(new HomingServer(std::move(state)));
}

void HomingServer::Drain() {
  if (!state_->core) {
    return;
  }
  state_->watch.reset();
  if (auto* health = state_->server->GetHealthCheckService()) {
    health->SetServingStatus(false);
  }
  state_->core->streams.Drain();
  state_->server->Shutdown(std::chrono::system_clock::now() + state_->drain_time);
  state_->server->Wait();
  state_->core->streams.AwaitNone();
  state_->server.reset();
  state_->core.reset();
}

}  // namespace homing::server
