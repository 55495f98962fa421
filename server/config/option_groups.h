// Flags of homing-server that belong together, and the same as TOML. Source: own design.
#ifndef SERVER_CONFIG_OPTION_GROUPS_H_
#define SERVER_CONFIG_OPTION_GROUPS_H_

#include <CLI/CLI.hpp>
#include <string>

#include "server/access/certificate_folder.h"
#include "server/admission/limits.h"
#include "server/config/server_options.h"

namespace homing::server {

// TLS, tokens, roles.
void AddAccessOptions(CLI::App* app, ServerOptions* options);
void AddLimitOptions(CLI::App* app, Limits* limits);
// The subcommands; each must outlive the parsing.
CLI::App* AddCertsCommand(CLI::App* app, CertificateOrder* order);
CLI::App* AddTokenCommand(CLI::App* app, TokenOrder* order);

std::string AccessToToml(const ServerOptions& options);
std::string LimitsToToml(const Limits& limits);

}  // namespace homing::server

#endif  // SERVER_CONFIG_OPTION_GROUPS_H_
