#include "client/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/backoff.h"
#include "client/rpc_status.h"
#include "client/server_address.h"
#include "client/server_list.h"
#include "client/token_interceptor.h"
#include "homing/base/field_error.h"
#include "homing/base/file_text.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// A robot's wall clock jumps when it is set.
using Clock = std::chrono::steady_clock;

constexpr int kReconnectBackoffMs = 100;
// A client finds a restarted server within a second.
constexpr int kMaxReconnectBackoffMs = 700;
constexpr std::chrono::milliseconds kStopCheck{100};
// Time after a refusal: enough for one more attempt, for a server that is starting.
constexpr std::chrono::milliseconds kSecondAttempt{400};

absl::StatusOr<std::string> ReadPem(const std::string& flag, const std::string& path) {
  if (path.empty()) return std::string();
  absl::StatusOr<std::string> text = ReadFile(path);
  return text.ok() ? std::move(text) : Within(flag, text.status());
}

bool IsThisMachine(const std::string& address) {
  const std::vector<std::string> servers = ServersOf(address);
  return std::all_of(servers.begin(), servers.end(), [](const std::string& server) {
    return absl::StartsWith(server, "127.0.0.1:") || absl::StartsWith(server, "localhost:") ||
           absl::StartsWith(server, "[::1]:") || IsUnixSocket(server);
  });
}

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeCredentials(
    const ConnectionOptions& options) {
  if (!UsesTls(options)) {
    return grpc::InsecureChannelCredentials();
  }
  if (options.tls_cert.empty() != options.tls_key.empty()) {
    return absl::InvalidArgumentError("--tls-cert and --tls-key must be given together");
  }
  grpc::SslCredentialsOptions ssl;
  HOMING_ASSIGN_OR_RETURN(ssl.pem_root_certs, ReadPem("--tls-ca", options.tls_ca));
  HOMING_ASSIGN_OR_RETURN(ssl.pem_cert_chain, ReadPem("--tls-cert", options.tls_cert));
  HOMING_ASSIGN_OR_RETURN(ssl.pem_private_key, ReadPem("--tls-key", options.tls_key));
  return grpc::SslCredentials(ssl);
}

// gRPC's own resolver supports neither mDNS nor the system's other name services. gRPC reads the
// variable when it starts, so this runs before the first channel. A value set by the user stays.
void UseResolverOfSystem() { ::setenv("GRPC_DNS_RESOLVER", "native", /*overwrite=*/0); }

grpc::ChannelArguments MakeArguments(const std::string& address) {
  grpc::ChannelArguments arguments;
  // Detects a dead link within half a minute, even without traffic; with another server to go to,
  // within three seconds.
  const bool many = MayBeMany(address);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, many ? 1000 : 20000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, many ? 2000 : 10000);
  if (many) {
    arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    arguments.SetLoadBalancingPolicyName("round_robin");
    // The name that a certificate must have, where the target holds numbers.
    arguments.SetString(GRPC_ARG_DEFAULT_AUTHORITY, ServersOf(address)[0]);
  }
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kReconnectBackoffMs);
  // Time of one attempt to connect, with TLS: a slow radio link takes seconds.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kMaxReconnectBackoffMs);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, MayUseProxy(address) ? 1 : 0);
  // Resolves the name again at once after a failure; the default is every 30 s.
  arguments.SetInt(GRPC_ARG_DNS_MIN_TIME_BETWEEN_RESOLUTIONS_MS, kMaxReconnectBackoffMs);
  // Each Connection has its own TCP connection, so that a program with several does not lose all at
  // once.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  // The server limits messages; answers hold no images.
  arguments.SetMaxReceiveMessageSize(64 * 1024 * 1024);
  return arguments;
}

}  // namespace

bool UsesTls(const ConnectionOptions& options) {
  return !options.tls_ca.empty() || !options.tls_cert.empty() || !options.tls_key.empty();
}

absl::StatusOr<std::string> ReadToken(const ConnectionOptions& options) {
  HOMING_ASSIGN_OR_RETURN(const std::string text, ReadPem("--token-file", options.token_file));
  const std::string token(absl::StripAsciiWhitespace(text));
  const bool printable = std::all_of(token.begin(), token.end(), absl::ascii_isgraph);
  if (!options.token_file.empty() && (token.empty() || !printable)) {
    return absl::InvalidArgumentError(
        absl::StrCat("--token-file: ", options.token_file, " does not hold one token"));
  }
  if (!token.empty() && !UsesTls(options) && !options.insecure && !IsThisMachine(options.address)) {
    return absl::InvalidArgumentError(
        absl::StrCat("--token-file: the token would be sent to ", options.address,
                     " in plain text; give --tls-ca, or --insecure if the network is trusted"));
  }
  return token;
}

Connection::Connection(ConnectionOptions options, std::shared_ptr<grpc::Channel> channel)
    : options_(std::move(options)), channel_(std::move(channel)) {}

absl::StatusOr<Connection> Connection::Open(const ConnectionOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckServerAddress(options.address));
  UseResolverOfSystem();
  HOMING_ASSIGN_OR_RETURN(const auto credentials, MakeCredentials(options));
  HOMING_ASSIGN_OR_RETURN(const std::string token, ReadToken(options));
  HOMING_ASSIGN_OR_RETURN(const std::string target, ChannelTarget(options.address));
  const grpc::ChannelArguments arguments = MakeArguments(options.address);
  return Connection(options,
                    grpc::experimental::CreateCustomChannelWithInterceptors(
                        target, credentials, arguments, SendToken(token, options.traceparent)));
}

absl::Status Connection::WaitForServer() const {
  auto limit = Clock::now() + options_.connect_timeout;
  bool refused = false;
  for (auto state = channel_->GetState(/*try_to_connect=*/true); state != GRPC_CHANNEL_READY;
       state = channel_->GetState(true)) {
    if (state == GRPC_CHANNEL_TRANSIENT_FAILURE && !refused) {
      refused = true;
      limit = std::min(limit, Clock::now() + kSecondAttempt);
    }
    const auto left = limit - Clock::now();
    if (state == GRPC_CHANNEL_SHUTDOWN || left <= left.zero() ||
        !channel_->WaitForStateChange(state, std::chrono::system_clock::now() + left)) {
      return ExplainUnreachable(options_.address, UsesTls(options_));
    }
  }
  return absl::OkStatus();
}

bool Connection::AwaitReady(const std::stop_token& stop) const {
  const auto until = Clock::now() + std::chrono::milliseconds(kMaxReconnectBackoffMs);
  while (!stop.stop_requested()) {
    const auto state = channel_->GetState(/*try_to_connect=*/true);
    if (state == GRPC_CHANNEL_READY) return true;
    const auto left = until - Clock::now();
    if (state == GRPC_CHANNEL_SHUTDOWN || left <= left.zero()) return false;
    const auto slice = std::min<Clock::duration>(left, kStopCheck);
    channel_->WaitForStateChange(state, std::chrono::system_clock::now() + slice);
  }
  return false;
}

absl::Status Connection::Retry(const std::stop_token& stop,
                               const std::function<absl::Status()>& call) const {
  const auto deadline = Clock::now() + options_.retry_for;
  Backoff backoff;
  while (true) {
    absl::Status status = call();
    if (!IsRetriable(status) || Clock::now() >= deadline) return status;
    const auto wait =
        std::max(backoff.Next(), RetryDelay(status).value_or(std::chrono::milliseconds(0)));
    if (!SleepFor(wait, stop)) return absl::CancelledError("stopped");
    AwaitReady(stop);
    if (stop.stop_requested()) return absl::CancelledError("stopped");
  }
}

}  // namespace homing::client
