// Asks a server for its health.
#ifndef SERVER_CONFIG_HEALTH_CHECK_H_
#define SERVER_CONFIG_HEALTH_CHECK_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// PEM files; all empty: no TLS.
struct HealthCheckFiles {
  // CA of the server's certificate.
  std::string ca;
  // Or the certificate itself, whatever host it is made out to.
  std::string trusted;
  // To show.
  std::string cert;
  std::string key;
};

// OK: it serves. Never through a proxy. UNAVAILABLE; INVALID_ARGUMENT: address, a file.
absl::Status CheckHealth(const std::string& address, const HealthCheckFiles& files = {});

}  // namespace homing::server

#endif  // SERVER_CONFIG_HEALTH_CHECK_H_
