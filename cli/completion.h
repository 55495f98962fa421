// Completion scripts of a program for shells, from its declared options.
#ifndef CLI_COMPLETION_H_
#define CLI_COMPLETION_H_

#include <CLI/CLI.hpp>
#include <string>

namespace homing {

// Both complete subcommands, flags, the words that a flag accepts, and file names elsewhere.
std::string ToBashCompletion(const CLI::App& app);
std::string ToZshCompletion(const CLI::App& app);

}  // namespace homing

#endif  // CLI_COMPLETION_H_
