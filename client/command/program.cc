#include "client/command/program.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
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

// True if the surplus arguments are files, as after the shell has expanded a glob.
bool NamesFiles(const CLI::App& app) {
  const std::vector<std::string> rest = app.remaining(/*recurse=*/true);
  std::error_code error;
  return !rest.empty() && std::all_of(rest.begin(), rest.end(), [&](const std::string& name) {
    return std::filesystem::exists(name, error);
  });
}

}  // namespace

int RunProgram(CLI::App& app, Session& session, int argc, char** argv) {
  SkipLockChecks();
  std::stop_source stop;
  StopAtSignal(stop);
  session.stop = stop.get_token();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    if (!NamesFiles(app)) return app.exit(error) == 0 ? 0 : kUsage;
    std::fputs(absl::StrCat(session.program,
                            ": error: more than one file stands where one SOURCE belongs; put a "
                            "glob in quotes, as in --left 'frames/*.png'\n")
                   .c_str(),
               stderr);
    return kUsage;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  return ExitCode(session, session.run());
}

}  // namespace homing::client
