// The server's HTTP side: the console with its API and events, GET /metrics and GET /healthz.
#ifndef SERVER_HTTP_CONSOLE_SERVER_H_
#define SERVER_HTTP_CONSOLE_SERVER_H_

#include <grpcpp/channel.h>

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/access/access_control.h"

namespace homing::server {

struct ConsoleOptions {
  // host:port; port 0 picks one.
  std::string address;
  // PEM files; empty: no TLS.
  std::string tls_cert;
  std::string tls_key;
  // As ServerOptions::http_host and http_user_header.
  std::string hosts;
  std::string user_header;
};

// The objects that the console shows; all must outlive it.
struct ConsoleContext {
  AccessControl* access = nullptr;
  // A channel to the server in this process.
  std::shared_ptr<grpc::Channel> channel;
  std::function<std::string()> metrics;
  std::function<bool()> healthy;
};

// Thread-safe; it serves on its own threads.
class ConsoleServer {
 public:
  // UNAVAILABLE: the address is in use or not available; INVALID_ARGUMENT: the TLS files are bad.
  static absl::StatusOr<std::unique_ptr<ConsoleServer>> Start(const ConsoleOptions& options,
                                                              const ConsoleContext& context);
  // Waits for the requests that still run: their calls must have been ended.
  ~ConsoleServer();

  // Accepts no more connections and closes all. Idempotent.
  void Stop();

  // "host:port", with the port that was picked.
  const std::string& address() const;
  // "http://host:port" or "https://host:port".
  std::string url() const;
  // A link that logs an operator in once, within 15 minutes.
  absl::StatusOr<std::string> MakeLoginLink(const std::string& identity);
  // Reads the certificate again. INVALID_ARGUMENT: it cannot be used; the previous one stays in
  // use.
  absl::Status ReloadCertificate();

 private:
  struct State;
  explicit ConsoleServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace homing::server

#endif  // SERVER_HTTP_CONSOLE_SERVER_H_
