// A file that a command writes: whole, or not there. Source: own design.
#ifndef CLIENT_FILE_OUTPUT_FILE_H_
#define CLIENT_FILE_OUTPUT_FILE_H_

#include <cstdint>
#include <functional>
#include <ostream>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client {

// "cannot write PATH: REASON", with the code of the system's error.
absl::Status CannotWrite(const std::string& path, int error);

// Whether a file can be written there, before the work begins; makes it if it is not there.
absl::Status CheckWritable(const std::string& path);

// Makes `path` of what `write` writes and returns its size in bytes. A plain file is replaced when
// all is written; a link stays one; devices and pipes are written into (size 0), a pipe
// once someone reads it. Errors: those of `write`, and the system's, for a file without write
// permission too; CANCELLED: stopped while nobody read the pipe.
absl::StatusOr<std::uintmax_t> WriteOutputFile(
    const std::string& path, const std::function<absl::Status(std::ostream&)>& write,
    const std::stop_token& stop = {});

}  // namespace homing::client

#endif  // CLIENT_FILE_OUTPUT_FILE_H_
