#include "client/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "client/backoff.h"
#include "client/rpc_status.h"
#include "homing/status_macros.h"

namespace homing::client {
namespace {

using Clock = std::chrono::system_clock;

absl::StatusOr<std::string> ReadPem(const std::string& flag, const std::string& path) {
  if (path.empty()) return std::string();
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::NotFoundError(absl::StrCat(flag, ": cannot read ", path));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeCredentials(
    const ConnectionOptions& options) {
  if (options.tls_ca.empty() && options.tls_cert.empty() && options.tls_key.empty()) {
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

grpc::ChannelArguments MakeArguments(const ConnectionOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, options.own_connection ? 1 : 0);
  // A dead link shows itself within half a minute even when nothing is sent.
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 20000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10000);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  // gRPC's time for one attempt to connect, TLS and all: a slow radio link takes seconds.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 2000);
  // A Connection is a connection: programs with several of them do not lose all at once.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  // The server limits messages; answers hold no images.
  arguments.SetMaxReceiveMessageSize(64 * 1024 * 1024);
  return arguments;
}

}  // namespace

Connection::Connection(ConnectionOptions options, std::shared_ptr<grpc::Channel> channel)
    : options_(std::move(options)), channel_(std::move(channel)) {}

absl::StatusOr<Connection> Connection::Open(const ConnectionOptions& options) {
  HOMING_ASSIGN_OR_RETURN(const auto credentials, MakeCredentials(options));
  return Connection(
      options, grpc::CreateCustomChannel(options.address, credentials, MakeArguments(options)));
}

absl::Status Connection::WaitForServer() const {
  const auto deadline = Clock::now() + options_.connect_timeout;
  auto state = channel_->GetState(/*try_to_connect=*/true);
  while (state != GRPC_CHANNEL_READY) {
    const bool changed = state != GRPC_CHANNEL_TRANSIENT_FAILURE &&
                         state != GRPC_CHANNEL_SHUTDOWN &&
                         channel_->WaitForStateChange(state, deadline);
    if (!changed) {
      return absl::UnavailableError(
          absl::StrCat("no server answers at ", options_.address, " (--server)"));
    }
    state = channel_->GetState(true);
  }
  return absl::OkStatus();
}

absl::Status Connection::Retry(const std::stop_token& stop,
                               const std::function<absl::Status()>& call) const {
  const auto deadline = Clock::now() + options_.retry_for;
  Backoff backoff;
  while (true) {
    absl::Status status = call();
    if (!IsRetriable(status) || Clock::now() >= deadline) return status;
    const auto wait = std::max(backoff.Next(), RetryDelay(status).value_or(backoff.Next()));
    if (!SleepFor(wait, stop)) return absl::CancelledError("stopped");
  }
}

}  // namespace homing::client
