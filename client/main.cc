// The `homing` command: parses the command line, runs one command, returns its exit code.
#include <CLI/CLI.hpp>

#include "client/command/commands.h"
#include "client/command/program.h"
#include "client/command/session.h"

int main(int argc, char** argv) {
  homing::client::Session session;
  CLI::App app("Records journeys of robots on a homing-server and finds the way home",
               session.program);
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
  homing::client::AddBackupCommand(app, session);
  homing::client::AddTopCommand(app, session);
  homing::client::AddEvaluateCommand(app, session);
  return homing::client::RunProgram(app, session, argc, argv);
}
