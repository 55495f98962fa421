// A file that a command writes: complete, or not at all.
#ifndef CLIENT_FILE_OUTPUT_FILE_H_
#define CLIENT_FILE_OUTPUT_FILE_H_

#include <cstdint>
#include <functional>
#include <ostream>
#include <stop_token>
#include <string>
#include <utility>

#include "absl/status/statusor.h"

namespace homing::client {

// "cannot write PATH: REASON", with the code of the system's error.
absl::Status CannotWrite(const std::string& path, int error);

// OK: the file can be written. Call it before the work begins; it creates a missing file.
absl::Status CheckWritable(const std::string& path);

// Holds a pipe open for writing: its reader sees no end until the file is opened and written.
class HeldPipe {
 public:
  HeldPipe() = default;
  explicit HeldPipe(int file) : file_(file) {}
  HeldPipe(HeldPipe&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  HeldPipe& operator=(HeldPipe&&) = delete;
  ~HeldPipe();

 private:
  int file_ = -1;
};

// Returns once a program reads the pipe `path`, for other files at once. CANCELLED: stopped before.
absl::StatusOr<HeldPipe> AwaitReader(const std::string& path, const std::stop_token& stop);

// Writes to standard output and checks that all has arrived, which a full disk may not take.
absl::Status WriteStandardOutput(const std::function<absl::Status(std::ostream&)>& write);

// Creates or replaces `path` with the output of `write`; returns its size in bytes. A plain file is
// replaced when all is written; a link stays a link; devices and pipes are written into (size 0), a
// pipe once a program reads it. Errors of `write`, and the system's, for a file without write
// permission too; CANCELLED: stopped while no program read the pipe.
absl::StatusOr<std::uintmax_t> WriteOutputFile(
    const std::string& path, const std::function<absl::Status(std::ostream&)>& write,
    const std::stop_token& stop = {});

// "PATH: 12 bytes", for the user.
std::string WrittenFile(const std::string& path, std::uintmax_t bytes);

}  // namespace homing::client

#endif  // CLIENT_FILE_OUTPUT_FILE_H_
