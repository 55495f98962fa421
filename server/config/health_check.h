// Asks a server for its health. Source: own design, over the standard gRPC health service.
#ifndef SERVER_CONFIG_HEALTH_CHECK_H_
#define SERVER_CONFIG_HEALTH_CHECK_H_

#include <string>

#include "absl/status/status.h"

namespace homing::server {

// OK: it serves. `ca_file`: CA of its certificate, PEM; empty: no TLS. UNAVAILABLE, and what
// reading the file says.
absl::Status CheckHealth(const std::string& address, const std::string& ca_file,
                         const std::string& cert_file = "", const std::string& key_file = "");

}  // namespace homing::server

#endif  // SERVER_CONFIG_HEALTH_CHECK_H_
