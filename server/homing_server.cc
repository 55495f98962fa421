#include "server/homing_server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/resource_quota.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"
#include "server/core_gauges.h"
#include "server/housekeeping.h"
#include "server/http/console_server.h"
#include "server/service/deviation_model_service.h"
#include "server/service/fleet_service.h"
#include "server/service/homing_service.h"
#include "server/service/journey_service.h"
#include "server/service/store_service.h"
#include "server/store_watch.h"
#include "server/tls_credentials.h"

namespace homing::server {
namespace {

// The shortest interval at which clients may ping.
constexpr int kMinPingIntervalMs = 500;
// Time for the streams of a connection that has become too old.
constexpr int kAgeGraceMs = 10'000;
// Usually higher than --max-streams: the server refuses a stream beyond --max-streams with a
// reason, while a stream beyond this limit waits.
constexpr int kMaxConnectionStreams = 16'384;
// The library's reflection holds a thread for each stream, and needs no identity. Further streams
// are refused.
constexpr int kMaxReflectionThreads = 32;
// A token and the headers that proxies add take a few hundred bytes.
constexpr int kMaxHeaderBytes = 8'192;

// Removes reflection, whose library adds a plugin to every server of the process.
class WithoutReflection : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments* /*arguments*/) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    std::erase_if(*plugins,
                  [](const auto& plugin) { return plugin->name() == "proto_server_reflection"; });
  }
};

CoreOptions CoreOptionsOf(const ServerOptions& options, std::function<TimePoint()> clock) {
  CoreOptions core;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  core.workers = options.workers > 0 ? options.workers : std::max(cores, 1);
  core.decode.max_pixels = options.max_pixels;
  core.wire.max_vectors = options.max_vectors;
  core.catalog.cache_bytes = options.map_cache;
  core.catalog.belief_bytes = options.limits.memory_quota;
  core.all_journeys_index = options.all_journeys_index;
  core.limits = options.limits;
  if (clock) {
    core.clock = std::move(clock);
  }
  return core;
}

void Configure(const ServerOptions& options, grpc::ServerBuilder* builder) {
  builder->SetMaxReceiveMessageSize(static_cast<int>(options.max_message));
  // gRPC unpacks a message to a thousand times its size before it looks at the limit.
  builder->SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  builder->SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder->AddChannelArgument(GRPC_ARG_ENABLE_PER_MESSAGE_DECOMPRESSION, 0);
  // A second server on the same port must fail, not share it silently.
  builder->AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  // Detects dead radio links soon.
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, options.limits.keepalive_s * 1000);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, options.limits.keepalive_s * 500);
  builder->AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                              kMinPingIntervalMs);
  builder->AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  if (options.max_connection_age_s > 0) {
    builder->AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS,
                                options.max_connection_age_s * 1000);
    builder->AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_GRACE_MS, kAgeGraceMs);
  }
  // HTTP/2 announces these limits to each connection.
  builder->AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxConnectionStreams);
  builder->AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMaxHeaderBytes);
  grpc::ResourceQuota quota("homing");
  quota.SetMaxThreads(kMaxReflectionThreads);
  if (options.limits.memory_quota > 0) {
    quota.Resize(static_cast<std::size_t>(options.limits.memory_quota));
  }
  builder->SetResourceQuota(quota);
  if (options.no_reflection) {
    builder->SetOption(std::make_unique<WithoutReflection>());
  }
}

}  // namespace

struct HomingServer::State {
  State(std::unique_ptr<storage::JourneyStore> store, std::shared_ptr<AccessControl> access,
        const CoreOptions& options)
      : core(std::make_unique<ServiceCore>(std::move(store), std::move(access), options)),
        journeys(core.get()),
        homing(core.get()),
        models(core.get()),
        backup(core.get()),
        fleet(core.get()) {}

  absl::Status Listen(const ServerOptions& options);
  absl::Status ServeHttp(const ServerOptions& options);

  // Null: plain text.
  std::unique_ptr<TlsFiles> tls_files;
  // Reset once drained.
  std::unique_ptr<ServiceCore> core;
  JourneyServiceHandler journeys;
  HomingServiceHandler homing;
  DeviationModelServiceHandler models;
  StoreServiceHandler backup;
  FleetServiceHandler fleet;
  std::unique_ptr<grpc::Server> server;
  // Must end before `server`, whose health it sets.
  std::unique_ptr<StoreWatch> watch;
  std::unique_ptr<ConsoleServer> console;
  std::unique_ptr<Housekeeping> housekeeping;
  std::string address;
  // The store accepts writes.
  std::atomic<bool> well = true;
  std::chrono::milliseconds drain_time{};
};

absl::Status HomingServer::State::Listen(const ServerOptions& options) {
  if (!options.tls_cert.empty()) {
    HOMING_ASSIGN_OR_RETURN(
        tls_files, TlsFiles::Open(options.tls_cert, options.tls_key, options.tls_client_ca));
  }
  const auto credentials = MakeServerCredentials(options, tls_files.get(), core->access);
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  Configure(options, &builder);
  int port = 0;
  builder.AddListeningPort(options.listen, credentials, &port);
  builder.RegisterService(&journeys);
  builder.RegisterService(&homing);
  builder.RegisterService(&models);
  builder.RegisterService(&backup);
  builder.RegisterService(&fleet);
  server = builder.BuildAndStart();
  const bool is_socket_file = IsUnixSocket(options.listen);
  if (server == nullptr || (port <= 0 && !is_socket_file)) {
    return absl::UnavailableError(absl::StrCat(
        "listen: \"", options.listen, "\" is in use or is not an address of this machine",
        options.tls_cert.empty() ? "" : ", or the TLS files are bad"));
  }
  address = is_socket_file
                ? options.listen
                : absl::StrCat(options.listen.substr(0, options.listen.rfind(':')), ":", port);
  drain_time = std::chrono::milliseconds(options.drain_ms);
  watch = std::make_unique<StoreWatch>(core->store.get(), [this](bool works) {
    well = works;
    if (auto* health = server->GetHealthCheckService()) {
      health->SetServingStatus(works);
    }
  });
  return absl::OkStatus();
}

absl::Status HomingServer::State::ServeHttp(const ServerOptions& options) {
  if (!HasHttp(options)) {
    return absl::OkStatus();
  }
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  ConsoleContext context;
  context.access = core->access.get();
  context.channel = server->InProcessChannel(arguments);
  context.metrics = [metrics = core->metrics.get()] { return metrics->Text(); };
  context.healthy = [this] { return well && !core->streams.draining(); };
  absl::StatusOr<std::unique_ptr<ConsoleServer>> started =
      ConsoleServer::Start({options.http, options.tls_cert, options.tls_key, options.http_host,
                            options.http_user_header},
                           context);
  if (!started.ok() && options.http_optional) {
    spdlog::warn("no console, no metrics: {}", std::string(started.status().message()));
    return absl::OkStatus();
  }
  HOMING_ASSIGN_OR_RETURN(console, std::move(started));
  return absl::OkStatus();
}

HomingServer::HomingServer(std::unique_ptr<State> state) : state_(std::move(state)) {}

HomingServer::~HomingServer() { Drain(); }

const std::string& HomingServer::address() const { return state_->address; }

std::string HomingServer::metrics_address() const {
  return state_->console ? state_->console->address() : "";
}

std::string HomingServer::console_link(bool first_start) const {
  if (!state_->console) return "";
  if (state_->core->access->is_open() || !first_start) return state_->console->url();
  const auto link = state_->console->MakeLoginLink("operators/first");
  return link.ok() ? *link : state_->console->url();
}

std::string HomingServer::MetricsText() const {
  return state_->core ? state_->core->metrics->Text() : "";
}

absl::StatusOr<std::unique_ptr<HomingServer>> HomingServer::Start(
    const ServerOptions& options, std::function<TimePoint()> clock) {
  HOMING_RETURN_IF_ERROR(Validate(options));
  HOMING_ASSIGN_OR_RETURN(auto access,
                          AccessControl::Open({options.tokens, options.roles, options.tls_client_ca,
                                               options.tls_crl_dir}));
  storage::StoreOptions store_options;
  store_options.url = options.database;
  store_options.read_only = options.readonly;
  store_options.max_bytes = options.limits.max_database;
  HOMING_ASSIGN_OR_RETURN(auto store, storage::OpenJourneyStore(store_options));
  auto state = std::make_unique<State>(std::move(store), std::move(access),
                                       CoreOptionsOf(options, std::move(clock)));
  AddCoreGauges(options, state->core.get());
  HOMING_RETURN_IF_ERROR(state->Listen(options));
  HOMING_RETURN_IF_ERROR(state->ServeHttp(options));
  state->housekeeping = std::make_unique<Housekeeping>(
      state->core.get(), std::chrono::seconds(options.reload_s), CertificateFilesOf(options),
      [tls_files = state->tls_files.get(), console = state->console.get()] {
        absl::Status status = tls_files == nullptr ? absl::OkStatus() : tls_files->Reload();
        if (console != nullptr) status.Update(console->ReloadCertificate());
        return status;
      });
  return std::unique_ptr<HomingServer>(new HomingServer(std::move(state)));
}

void HomingServer::Reload() {
  if (state_->housekeeping) {
    state_->housekeeping->Reload(AccessControl::Reading::kAtOnce);
  }
}

void HomingServer::Drain() {
  if (!state_->core) {
    return;
  }
  state_->watch.reset();
  state_->housekeeping.reset();
  if (auto* health = state_->server->GetHealthCheckService()) {
    health->SetServingStatus(false);
  }
  state_->core->streams.Drain();
  if (state_->console) state_->console->Stop();
  // Also ends the calls that the console waits for.
  state_->server->Shutdown(std::chrono::system_clock::now() + state_->drain_time);
  state_->console.reset();
  state_->server->Wait();
  state_->core->streams.AwaitNone();
  state_->server.reset();
  state_->core.reset();
}

}  // namespace homing::server
