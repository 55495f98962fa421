// A file that a command writes while it runs. It can be read at any time.
#ifndef CLIENT_COMMAND_GROWING_FILE_H_
#define CLIENT_COMMAND_GROWING_FILE_H_

#include <fstream>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client {

// Replaces the content; devices and pipes are written into, a pipe once a program reads it. Errors
// of the system, for a file without write permission too; CANCELLED: stopped before.
absl::StatusOr<std::ofstream> OpenGrowingFile(const std::string& path,
                                              const std::stop_token& stop = {});

}  // namespace homing::client

#endif  // CLIENT_COMMAND_GROWING_FILE_H_
