// `homing-server certs` and `homing-server token`.
#ifndef SERVER_CONFIG_ACCESS_COMMANDS_H_
#define SERVER_CONFIG_ACCESS_COMMANDS_H_

#include <string>

#include "absl/status/status.h"
#include "server/config/server_options.h"

namespace homing::server {

// Prints the paths that it wrote. INVALID_ARGUMENT.
absl::Status RunCerts(const CertificateOrder& order);

// Adds a hash to the file `tokens`; never prints the token. INVALID_ARGUMENT.
absl::Status RunToken(const TokenOrder& order, const std::string& tokens);

}  // namespace homing::server

#endif  // SERVER_CONFIG_ACCESS_COMMANDS_H_
