// A server's address and TLS settings, for calls without gRPC.
#ifndef CLIENT_BENCH_HTTP2_ENDPOINT_H_
#define CLIENT_BENCH_HTTP2_ENDPOINT_H_

#include <openssl/ssl.h>

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/connection.h"

namespace homing::client {

// Copies share their TLS settings. Immutable.
class Http2Endpoint {
 public:
  // INVALID_ARGUMENT: no "host:port"; files as Connection::Open.
  static absl::StatusOr<Http2Endpoint> Make(const ConnectionOptions& options);

  // A connected socket. UNAVAILABLE.
  absl::StatusOr<int> Dial() const;
  // TLS on a connected socket, after its handshake; null without TLS. UNAVAILABLE.
  absl::StatusOr<std::shared_ptr<SSL>> Secure(int socket) const;
  const std::string& authority() const { return authority_; }
  // "" without a token.
  const std::string& token() const { return token_; }

 private:
  std::string authority_;
  std::string host_;
  std::string port_;
  std::string token_;
  std::shared_ptr<SSL_CTX> tls_;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_HTTP2_ENDPOINT_H_
