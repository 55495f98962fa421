// The whole command line of `homing`.
#ifndef CLIENT_COMMAND_COMMAND_LINE_H_
#define CLIENT_COMMAND_COMMAND_LINE_H_

#include <CLI/CLI.hpp>
#include <span>

#include "cli/examples.h"
#include "client/command/session.h"

namespace homing::client {

// At least one for each command that does work.
std::span<const Example> CommandExamples();

// Declares all commands, their examples and the documentation. `session` must outlive `app`.
void AddCommandLine(CLI::App& app, Session& session, const char* version);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_COMMAND_LINE_H_
