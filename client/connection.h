// The channel to one server.
#ifndef CLIENT_CONNECTION_H_
#define CLIENT_CONNECTION_H_

#include <grpcpp/channel.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::client {

struct ConnectionOptions {
  // host:port or unix:path; several servers of one database as host:port,host:port or, for a name
  // with several addresses, dns:///host:port: calls go to all that answer in turn, and to another
  // one after a failure. Names are resolved as by every other program of the machine; a proxy of
  // the environment is used for public addresses only.
  std::string address = "127.0.0.1:50551";
  // PEM files. Any of them turns TLS on. Without `tls_ca` the system's roots are trusted.
  // Certificate and key (mutual TLS) must be given together.
  std::string tls_ca;
  std::string tls_cert;
  std::string tls_key;
  // File with a bearer token, for robots without a certificate. It is sent with every call; without
  // TLS only to this machine, unless `insecure`.
  std::string token_file;
  bool insecure = false;
  // W3C traceparent of the program that started this one; otherwise a new trace begins. Each call
  // sends the trace and its own span.
  std::string traceparent;
  // Longest time for the first connection.
  std::chrono::milliseconds connect_timeout{5000};
  // Time for which a broken connection is retried, since it last worked.
  std::chrono::milliseconds retry_for{60000};
  // Longest time without an answer, while one is awaited, until a stream counts as broken: enough
  // for the largest image over a slow radio link.
  std::chrono::milliseconds answer_time{60000};
};

bool UsesTls(const ConnectionOptions& options);
// "" without a token file. INVALID_ARGUMENT: the file holds no token, or the token would leave this
// machine in plain text; NOT_FOUND.
absl::StatusOr<std::string> ReadToken(const ConnectionOptions& options);

// Thread-safe.
class Connection {
 public:
  // Does not wait for the server. INVALID_ARGUMENT: an address of another form, a key without
  // certificate, a token that would be sent in plain text, or a file without a token; NOT_FOUND: a
  // file.
  static absl::StatusOr<Connection> Open(const ConnectionOptions& options);

  const std::shared_ptr<grpc::Channel>& channel() const { return channel_; }
  const ConnectionOptions& options() const { return options_; }

  // UNAVAILABLE with the address and the reason: no server answers. Returns after the second
  // refusal, and at the latest after `connect_timeout`.
  absl::Status WaitForServer() const;

  // Waits until the server is connected, for one attempt to reconnect at most. False: it is not.
  bool AwaitReady(const std::stop_token& stop) const;

  // Repeats a unary `call` while it IsRetriable, for `retry_for` since the first attempt.
  // CANCELLED: stopped.
  absl::Status Retry(const std::stop_token& stop, const std::function<absl::Status()>& call) const;

 private:
  Connection(ConnectionOptions options, std::shared_ptr<grpc::Channel> channel);

  ConnectionOptions options_;
  std::shared_ptr<grpc::Channel> channel_;
};

}  // namespace homing::client

#endif  // CLIENT_CONNECTION_H_
