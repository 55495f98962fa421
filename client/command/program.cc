#include "client/command/program.h"

#include <csignal>
#include <cstdlib>
#include <stop_token>
#include <thread>

#include "server/process/lock_checks.h"

namespace homing::client {
namespace {

constexpr int kUsage = 2;

void StopAtSignal(const std::stop_source& source) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // Before any other thread starts, so that all threads inherit it.
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

int RunProgram(CLI::App& app, Session& session, int argc, char** argv) {
  SkipLockChecks();
  std::stop_source stop;
  StopAtSignal(stop);
  session.stop = stop.get_token();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return ExitCode(session, session.run());
}

}  // namespace homing::client
