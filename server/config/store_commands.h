// The subcommands that work on a database file: doctor and backup.
#ifndef SERVER_CONFIG_STORE_COMMANDS_H_
#define SERVER_CONFIG_STORE_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <string>

#include "server/config/server_options.h"

namespace homing::server {

// Adds the subcommands to the command line. Not thread-safe.
class StoreCommands {
 public:
  // Both must outlive the object.
  StoreCommands(CLI::App* app, ServerCommand* command);
  // Call it after parsing: sets `command` and returns true if one of the subcommands was given.
  bool Choose(ServerCommand* command) const;

 private:
  CLI::App* doctor_;
  CLI::App* backup_;
};

// Each prints findings on stdout and failures on stderr. Returns the exit code: 0 if the file is
// whole or the work is done, 1 if it is damaged or failed.
int RunDoctor(const std::string& path, const std::string& salvage_to);
int RunBackup(const std::string& path, const std::string& to);

}  // namespace homing::server

#endif  // SERVER_CONFIG_STORE_COMMANDS_H_
