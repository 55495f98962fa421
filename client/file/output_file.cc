#include "client/file/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "absl/strings/str_cat.h"

namespace homing::client {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kReaderCheck{50};

using Write = std::function<absl::Status(std::ostream&)>;

// Writes and closes the file. Errors of the system; they contain `name`, the file as the user named
// it.
absl::Status WriteTo(const std::string& path, const std::string& name, const Write& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) return CannotWrite(name, errno);
  absl::Status status = write(file);
  errno = 0;
  file.close();
  if (status.ok() && !file) status = CannotWrite(name, errno == 0 ? ENOSPC : errno);
  return status;
}

// Writes beside the file and renames, so that the file is either complete or unchanged.
absl::Status Replace(const fs::path& path, const fs::file_status& before, const Write& write) {
  const std::string part = path.string() + ".part";
  absl::Status status = WriteTo(part, path.string(), write);
  std::error_code error;
  if (status.ok() && fs::exists(before)) fs::permissions(part, before.permissions(), error);
  if (status.ok() && std::rename(part.c_str(), path.c_str()) != 0) {
    status = CannotWrite(path.string(), errno);
  }
  if (!status.ok()) fs::remove(part, error);
  return status;
}

// The administrator could write to it, but its permissions forbid this.
bool IsReadOnly(const fs::file_status& file) {
  constexpr fs::perms kWritable =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  return fs::is_regular_file(file) && (file.permissions() & kWritable) == fs::perms::none;
}

}  // namespace

absl::Status CannotWrite(const std::string& path, int error) {
  return absl::ErrnoToStatus(error, absl::StrCat("cannot write ", path));
}

absl::Status CheckWritable(const std::string& path) {
  std::error_code error;
  const fs::file_status before = fs::status(path, error);
  if (IsReadOnly(before)) return CannotWrite(path, EACCES);
  if (fs::is_directory(before)) return CannotWrite(path, EISDIR);
  // Opening and closing a pipe would end its reader's input.
  if (fs::exists(before) && !fs::is_regular_file(before)) return absl::OkStatus();
  errno = 0;
  const std::ofstream file(path, std::ios::binary | std::ios::app);
  return file ? absl::OkStatus() : CannotWrite(path, errno);
}

// Opening a pipe without a reader would block, even when a signal arrives.
absl::StatusOr<HeldPipe> AwaitReader(const std::string& path, const std::stop_token& stop) {
  std::error_code error;
  if (!fs::is_fifo(path, error)) return HeldPipe();
  while (!stop.stop_requested()) {
    const int pipe = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (pipe >= 0) return HeldPipe(pipe);
    if (errno != ENXIO) return CannotWrite(path, errno);
    std::this_thread::sleep_for(kReaderCheck);
  }
  return absl::CancelledError(absl::StrCat("stopped; nobody reads ", path));
}

HeldPipe::~HeldPipe() {
  if (file_ >= 0) ::close(file_);
}

absl::Status WriteStandardOutput(const Write& write) {
  absl::Status status = write(std::cout);
  if (!status.ok()) return status;
  errno = 0;
  std::cout.flush();
  return std::cout ? absl::OkStatus()
                   : CannotWrite("to standard output", errno == 0 ? ENOSPC : errno);
}

absl::StatusOr<std::uintmax_t> WriteOutputFile(const std::string& path, const Write& write,
                                               const std::stop_token& stop) {
  std::error_code error;
  // A link stays a link: its target is replaced.
  fs::path target = fs::is_symlink(fs::symlink_status(path, error))
                        ? fs::weakly_canonical(path, error)
                        : fs::path(path);
  if (error || target.empty()) target = path;
  const fs::file_status before = fs::status(target, error);
  if (fs::is_directory(before)) return CannotWrite(path, EISDIR);
  const bool special = fs::exists(before) && !fs::is_regular_file(before);
  if (IsReadOnly(before)) return CannotWrite(path, EACCES);
  const absl::StatusOr<HeldPipe> pipe = AwaitReader(path, stop);
  if (!pipe.ok()) return pipe.status();
  const absl::Status status =
      special ? WriteTo(target.string(), path, write) : Replace(target, before, write);
  if (!status.ok()) return status;
  const std::uintmax_t size = special ? 0 : fs::file_size(target, error);
  return error ? 0 : size;
}

std::string WrittenFile(const std::string& path, std::uintmax_t bytes) {
  // Nobody counts what a device or a pipe takes.
  return bytes > 0 ? absl::StrCat(path, ": ", bytes, " bytes") : absl::StrCat(path, ": written");
}

}  // namespace homing::client
