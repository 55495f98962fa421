// Examples at the end of --help and in the man page.
#ifndef CLI_EXAMPLES_H_
#define CLI_EXAMPLES_H_

#include <CLI/CLI.hpp>
#include <span>

namespace homing {

struct Example {
  // The command without the program's name: "record", "journeys show"; empty: the program itself.
  const char* command;
  // A whole line as typed into a shell.
  const char* line;
};

// Adds each line to the help of its command. Call it when all commands are declared; an example of
// an unknown command is CLI::OptionNotFound.
void AddExamples(CLI::App& app, std::span<const Example> examples);

}  // namespace homing

#endif  // CLI_EXAMPLES_H_
