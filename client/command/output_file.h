// A file that a command writes: complete, or not at all.
#ifndef CLIENT_COMMAND_OUTPUT_FILE_H_
#define CLIENT_COMMAND_OUTPUT_FILE_H_

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client {

// Creates or replaces `path` with the output of `write`; returns its size in bytes. Errors of
// `write`, PERMISSION_DENIED, RESOURCE_EXHAUSTED.
absl::StatusOr<std::uintmax_t> WriteOutputFile(
    const std::string& path, const std::function<absl::Status(std::ostream&)>& write);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_OUTPUT_FILE_H_
