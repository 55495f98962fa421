// homing-server: options, signals, and the server's life.
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "server/config/access_commands.h"
#include "server/config/health_check.h"
#include "server/config/option_table.h"
#include "server/config/server_options.h"
#include "server/config/store_commands.h"
#include "server/homing_server.h"
#include "server/process/lock_checks.h"
#include "server/process/open_files.h"
#include "server/rpc/json_log.h"
#include "server/rpc/library_log.h"
#include "storage/database_url.h"

// Read by jemalloc. One arena, because one of the few threads often frees what another allocated.
// Free memory returns to the system soon: after a burst of a thousand robots it was as large as the
// memory in use.
extern "C" const char* malloc_conf;
const char* malloc_conf = "narenas:1,dirty_decay_ms:1000";

namespace {

using homing::server::HomingServer;
using homing::server::ServerCommand;

int Report(const absl::Status& status) {
  if (status.ok()) {
    return 0;
  }
  std::cerr << "homing-server: " << std::string(status.message()) << '\n';
  return 1;
}

// Blocked in this thread and all later ones, so that only Serve receives them.
sigset_t BlockStopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

// True if the database does not exist yet: nobody can have logged in.
bool IsNewDatabase(const homing::server::ServerOptions& options) {
  const auto path = homing::storage::ParseDatabaseUrl(options.database);
  std::error_code error;
  return path.ok() && !std::filesystem::exists(*path, error);
}

int Serve(const homing::server::ServerOptions& options) {
  const sigset_t signals = BlockStopSignals();
  homing::RaiseOpenFileLimit();
  homing::server::LimitLogOfLibraries();
  if (options.log_format == "json") {
    spdlog::default_logger()->set_formatter(homing::server::JsonLogFormatter());
  }
  const bool first_start = IsNewDatabase(options);
  const auto server = HomingServer::Start(options);
  if (!server.ok()) {
    return Report(server.status());
  }
  // One write: a reader of the first line may close the pipe.
  std::string lines = "listening on " + (*server)->address() + "\n";
  if (!(*server)->metrics_address().empty()) {
    lines += "metrics on " + (*server)->console_link(false) + "/metrics\n";
  }
  if (const std::string link = (*server)->console_link(first_start); !link.empty()) {
    lines += "console: " + link + "\n";
  }
  std::cout << lines << std::flush;
  if (homing::server::IsOpenToAll(options)) {
    spdlog::warn(
        "neither tokens nor tls-client-ca is set: everybody who reaches {} may read and change all "
        "journeys",
        (*server)->address());
  }
  int signal = 0;
  while (sigwait(&signals, &signal) == 0 && signal == SIGHUP) {
    spdlog::info("SIGHUP: reading certificates, tokens and roles again");
    (*server)->Reload();
  }
  spdlog::info("signal {}: draining", signal);
  (*server)->Drain();
  spdlog::info("stopped");
  return 0;
}

int Run(const ServerCommand& command) {
  switch (command.action) {
    case ServerCommand::Action::kExit:
      return command.exit_code;
    case ServerCommand::Action::kHealthCheck:
      return Report(homing::server::CheckHealth(
          command.health_server,
          {command.health_ca, command.health_trusted, command.health_cert, command.health_key}));
    case ServerCommand::Action::kCerts:
      return Report(homing::server::RunCerts(command.certificates));
    case ServerCommand::Action::kToken:
      return Report(homing::server::RunToken(command.token, command.options.tokens));
    case ServerCommand::Action::kCheckConfig: {
      const int result = Report(homing::server::Validate(command.options));
      std::cout << (result == 0 ? homing::server::ToToml(command.options) : "");
      return result;
    }
    case ServerCommand::Action::kDoctor:
      return homing::server::RunDoctor(command.store_path, command.target_path);
    case ServerCommand::Action::kBackup:
      return homing::server::RunBackup(command.store_path, command.target_path);
    case ServerCommand::Action::kServe:
      return Serve(command.options);
  }
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  homing::SkipLockChecks();
  spdlog::set_default_logger(spdlog::stderr_color_mt("homing-server"));
  const ServerCommand command = homing::server::ParseCommandLine(argc, argv);
  const int result = Run(command);
  // A server lives on where nobody reads its first lines.
  if (command.action == ServerCommand::Action::kServe || std::cout.flush()) return result;
  return Report(absl::DataLossError("standard output: not all of it could be written"));
}
