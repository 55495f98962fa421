// The `homing-bench` program: loads a server with many robots.
#include <CLI/CLI.hpp>

#include "client/bench/bench_command.h"
#include "client/command/program.h"

int main(int argc, char** argv) {
  homing::client::Session session;
  session.program = "homing-bench";
  CLI::App app(
      "Loads a homing-server with many robots; latencies from the time each message was due",
      session.program);
  app.set_version_flag("--version", "homing-bench " HOMING_VERSION);
  homing::client::AddCommonFlags(app, session);
  homing::client::AddBenchFlags(app, session);
  return homing::client::RunProgram(app, session, argc, argv);
}
