// The parts of a declared option that --help, the man page and the completion show.
#ifndef CLI_OPTION_TEXT_H_
#define CLI_OPTION_TEXT_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace homing {

// The visible options of the command, in the order in which they were declared.
std::vector<const CLI::Option*> VisibleOptions(const CLI::App& app);
std::vector<const CLI::App*> Subcommands(const CLI::App& app);
// "-q", "--quiet"; empty for a positional argument.
std::vector<std::string> FlagsOf(const CLI::Option& option);
// Whether a value follows the flag.
bool TakesValue(const CLI::Option& option);
// The words that the option accepts; empty: any text.
std::vector<std::string> ChoicesOf(const CLI::Option& option);
// The value's name in a synopsis: the choices, else the type.
std::string ValueName(const CLI::Option& option);

}  // namespace homing

#endif  // CLI_OPTION_TEXT_H_
