// The flags of `homing-bench`, and one run of it.
#ifndef CLIENT_BENCH_BENCH_COMMAND_H_
#define CLIENT_BENCH_BENCH_COMMAND_H_

#include <CLI/CLI.hpp>

#include "client/command/session.h"

namespace homing::client {

// Adds the flags to `app`, and sets Session::run when they are parsed.
void AddBenchFlags(CLI::App& app, Session& session);

}  // namespace homing::client

#endif  // CLIENT_BENCH_BENCH_COMMAND_H_
