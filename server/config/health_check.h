// Asks a server for its health, by the standard gRPC health service.
#ifndef SERVER_CONFIG_HEALTH_CHECK_H_
#define SERVER_CONFIG_HEALTH_CHECK_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// OK: the server is serving. `ca_file`: CA of its certificate, PEM; empty: no TLS. UNAVAILABLE: it
// does not serve or answer. INVALID_ARGUMENT: a file cannot be read.
absl::Status CheckHealth(const std::string& address, const std::string& ca_file,
                         const std::string& cert_file = "", const std::string& key_file = "");

}  // namespace homing::server

#endif  // SERVER_CONFIG_HEALTH_CHECK_H_
