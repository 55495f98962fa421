// The `homing` command: parses the command line, runs one command, returns its exit code.
#include <CLI/CLI.hpp>

#include "client/command/command_line.h"
#include "client/command/program.h"
#include "client/command/session.h"

int main(int argc, char** argv) {
  homing::client::Session session;
  CLI::App app("Records journeys of robots on a homing-server and finds the way home",
               session.program);
  homing::client::AddCommandLine(app, session, HOMING_VERSION);
  return homing::client::RunProgram(app, session, argc, argv);
}
