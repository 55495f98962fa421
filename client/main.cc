// The `homing` command: reads the command line, runs one command, gives its exit code.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <stop_token>
#include <thread>

#include "client/command/commands.h"
#include "client/command/session.h"
#include "server/process/lock_checks.h"

namespace {

constexpr int kUsage = 2;

// SIGINT and SIGTERM stop the command in good order; a second one ends the program.
void StopAtSignal(const std::stop_source& source) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // Before any other thread exists, so that all inherit it.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals, stop = source]() mutable {
    int signal = 0;
    sigwait(&signals, &signal);
    stop.request_stop();
    sigwait(&signals, &signal);
    std::_Exit(128 + signal);
  }).detach();
}

}  // namespace

int main(int argc, char** argv) {
  homing::SkipLockChecks();
  std::stop_source stop;
  StopAtSignal(stop);
  homing::client::Session session;
  session.stop = stop.get_token();
  CLI::App app("Records journeys of robots on a homing-server and finds the way home", "homing");
  app.set_version_flag("--version", "homing " HOMING_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  homing::client::AddCommonFlags(app, session);
  homing::client::AddRecordCommand(app, session);
  homing::client::AddLocalizeCommand(app, session);
  homing::client::AddMatchCommand(app, session);
  homing::client::AddJourneysCommand(app, session);
  homing::client::AddTrainCommand(app, session);
  homing::client::AddSimulateCommand(app, session);
  homing::client::AddDrawCommand(app, session);
  homing::client::AddBenchCommand(app, session);
  homing::client::AddBackupCommand(app, session);
  homing::client::AddEvaluateCommand(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return homing::client::ExitCode(session, session.run());
}
