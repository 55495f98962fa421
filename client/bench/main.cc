// The `homing-bench` program: loads a server with many robots.
#include <CLI/CLI.hpp>

#include "cli/documentation_flag.h"
#include "cli/examples.h"
#include "client/bench/bench_command.h"
#include "client/command/program.h"

namespace {

constexpr homing::Example kExamples[] = {
    {"", "homing-bench --robots 100 --rate 10 --seconds 30"},
    {"", "homing-bench --robots 1000 --localize --journeys 20 --json"}};

homing::ManPage Page() {
  homing::ManPage page;
  page.version = "homing-bench " HOMING_VERSION;
  page.exit_status = {"0: All robots were served.", "1: A robot failed.",
                      "2: The command line is wrong.", "3: The server cannot be reached."};
  page.see_also = {"homing(1)", "homing-server(8)"};
  return page;
}

}  // namespace

int main(int argc, char** argv) {
  homing::client::Session session;
  session.program = "homing-bench";
  CLI::App app(
      "Loads a homing-server with many robots; latencies from the time each message was due",
      session.program);
  app.set_version_flag("--version", "homing-bench " HOMING_VERSION);
  homing::client::AddCommonFlags(app, session);
  homing::client::AddBenchFlags(app, session);
  homing::AddExamples(app, kExamples);
  homing::AddDocumentationFlag(app, Page());
  return homing::client::RunProgram(app, session, argc, argv);
}
