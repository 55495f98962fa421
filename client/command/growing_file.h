// A file that a command writes while it runs. It can be read at any time.
#ifndef CLIENT_COMMAND_GROWING_FILE_H_
#define CLIENT_COMMAND_GROWING_FILE_H_

#include <fstream>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client {

// Replaces the file. INVALID_ARGUMENT: it is not a regular file; else the error of the system.
absl::StatusOr<std::ofstream> OpenGrowingFile(const std::string& path);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_GROWING_FILE_H_
