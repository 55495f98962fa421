// The commands of `homing`; each adds its flags and sets Session::run when chosen.
#ifndef CLIENT_COMMAND_COMMANDS_H_
#define CLIENT_COMMAND_COMMANDS_H_

#include <CLI/CLI.hpp>

#include "client/command/session.h"

namespace homing::client {

void AddRecordCommand(CLI::App& app, Session& session);
void AddLocalizeCommand(CLI::App& app, Session& session);
void AddMatchCommand(CLI::App& app, Session& session);
void AddJourneysCommand(CLI::App& app, Session& session);
void AddTrainCommand(CLI::App& app, Session& session);
void AddSimulateCommand(CLI::App& app, Session& session);
void AddDrawCommand(CLI::App& app, Session& session);
void AddBackupCommand(CLI::App& app, Session& session);
void AddDriveCommand(CLI::App& app, Session& session);
void AddTopCommand(CLI::App& app, Session& session);
void AddEvaluateCommand(CLI::App& app, Session& session);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_COMMANDS_H_
