#include "cli/examples.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace homing {

void AddExamples(CLI::App& app, std::span<const Example> examples) {
  for (const Example& example : examples) {
    CLI::App* command = &app;
    for (const auto& name : absl::StrSplit(example.command, ' ', absl::SkipEmpty())) {
      command = command->get_subcommand(std::string(name));
    }
    const std::string before = command->get_footer();
    command->footer(absl::StrCat(before.empty() ? "Example:" : before, "\n  ", example.line));
  }
}

}  // namespace homing
