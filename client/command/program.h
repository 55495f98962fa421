// The main() of a program with the flags of `homing`.
#ifndef CLIENT_COMMAND_PROGRAM_H_
#define CLIENT_COMMAND_PROGRAM_H_

#include <CLI/CLI.hpp>

#include "client/command/session.h"

namespace homing::client {

// Parses the command line, runs Session::run and returns the exit code: 2 for wrong usage, else
// that of ExitCode. The first SIGINT or SIGTERM stops the command cleanly; a second one ends the
// program. REQUIRES: no other thread was started.
int RunProgram(CLI::App& app, Session& session, int argc, char** argv);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_PROGRAM_H_
