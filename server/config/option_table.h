// The options of homing-server, each declared once.
#ifndef SERVER_CONFIG_OPTION_TABLE_H_
#define SERVER_CONFIG_OPTION_TABLE_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include "absl/status/status.h"
#include "server/config/server_options.h"

namespace homing::server {

// The name is the flag "--NAME", the key of the TOML file, the variable HOMING_NAME and the label
// of the metric. The default is that of the member in ServerOptions.
struct ServerOption {
  using Value = std::variant<std::string*, bool*, int*, std::int64_t*>;

  const char* name;
  Value (*value)(ServerOptions& options);
  const char* help;
  // Numbers only: the range and its unit. Values in "bytes" may be written as 16MiB.
  std::int64_t low = 0;
  std::int64_t high = 0;
  const char* unit = "";
  // 0 is valid though it is below `low`.
  bool zero_is_valid = false;
  // Shown as the metric homing_limit.
  bool is_limit = false;
};

void AddServerOptions(CLI::App* app, ServerOptions* options);
// INVALID_ARGUMENT naming the first number out of its range.
absl::Status CheckRanges(const ServerOptions& options);
// The options as a TOML file, one line each.
std::string ToToml(const ServerOptions& options);
// Calls `set` for each option that is a limit.
void ForEachLimit(const ServerOptions& options,
                  const std::function<void(const std::string& name, double value)>& set);

}  // namespace homing::server

#endif  // SERVER_CONFIG_OPTION_TABLE_H_
