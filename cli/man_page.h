// A manual page of a program, from its declared options.
#ifndef CLI_MAN_PAGE_H_
#define CLI_MAN_PAGE_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace homing {

struct ManPage {
  // 1: a command, 8: a program for the administrator.
  int section = 1;
  std::string version;
  // Lines "0: done".
  std::vector<std::string> exit_status;
  // Lines "FILE: meaning".
  std::vector<std::string> files;
  // "homing-server(8)".
  std::vector<std::string> see_also;
};

// troff text. The same declarations give the same bytes.
std::string ToManPage(const CLI::App& app, const ManPage& page);

}  // namespace homing

#endif  // CLI_MAN_PAGE_H_
