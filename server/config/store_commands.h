// The subcommands that work on a database file: doctor and backup.
#ifndef SERVER_CONFIG_STORE_COMMANDS_H_
#define SERVER_CONFIG_STORE_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <string>

#include "server/config/server_options.h"

namespace homing::server {

// Adds them to the command line.
class StoreCommands {
 public:
  // Both outlive the object.
  StoreCommands(CLI::App* app, ServerCommand* command);
  // After parsing: whether one of them was given, which `command` then asks for.
  bool Choose(ServerCommand* command) const;

 private:
  CLI::App* doctor_;
  CLI::App* backup_;
};

// Each tells on stdout what it found or did, on stderr what failed, and returns the exit code: 0
// whole or done; 1 damaged or failed.
int RunDoctor(const std::string& path, const std::string& salvage_to);
int RunBackup(const std::string& path, const std::string& to);

}  // namespace homing::server

#endif  // SERVER_CONFIG_STORE_COMMANDS_H_
