// Reads the files that options name.
#ifndef SERVER_ACCESS_FLAG_FILE_H_
#define SERVER_ACCESS_FLAG_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::server {

// INVALID_ARGUMENT with the option, the file and the problem.
absl::Status FlagFileError(const std::string& flag, const std::string& path,
                           const std::string& what);

// All of the regular file. INVALID_ARGUMENT: it is none, or cannot be read.
absl::StatusOr<std::string> ReadFlagFile(const std::string& flag, const std::string& path);

}  // namespace homing::server

#endif  // SERVER_ACCESS_FLAG_FILE_H_
