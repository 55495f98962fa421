// Asks a server for its health, by the standard gRPC health service.
#ifndef SERVER_CONFIG_HEALTH_CHECK_H_
#define SERVER_CONFIG_HEALTH_CHECK_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// PEM files; all empty: no TLS.
struct HealthCheckFiles {
  // CA of the server's certificate.
  std::string ca;
  // Instead of a CA: the server's certificate itself, valid for any host.
  std::string trusted;
  // The client's own certificate.
  std::string cert;
  std::string key;
};

// OK: the server is serving. Never through a proxy. UNAVAILABLE: it does not serve or answer.
// INVALID_ARGUMENT: the address, or a file that cannot be read.
absl::Status CheckHealth(const std::string& address, const HealthCheckFiles& files = {});

}  // namespace homing::server

#endif  // SERVER_CONFIG_HEALTH_CHECK_H_
