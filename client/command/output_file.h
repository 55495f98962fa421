// A file that a command writes: whole, or not there.
#ifndef CLIENT_COMMAND_OUTPUT_FILE_H_
#define CLIENT_COMMAND_OUTPUT_FILE_H_

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client {

// Makes `path` of what `write` writes and returns its size in bytes; a file that is there is
// replaced. Errors: those of `write`, PERMISSION_DENIED, RESOURCE_EXHAUSTED.
absl::StatusOr<std::uintmax_t> WriteOutputFile(
    const std::string& path, const std::function<absl::Status(std::ostream&)>& write);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_OUTPUT_FILE_H_
