// The hidden flag by which the build makes a program's man page and completion scripts.
#ifndef CLI_DOCUMENTATION_FLAG_H_
#define CLI_DOCUMENTATION_FLAG_H_

#include <CLI/CLI.hpp>

#include "cli/man_page.h"

namespace homing {

// --documentation man|bash|zsh prints the text and ends, as --help does. `app` must outlive the
// parsing.
void AddDocumentationFlag(CLI::App& app, ManPage page);

}  // namespace homing

#endif  // CLI_DOCUMENTATION_FLAG_H_
