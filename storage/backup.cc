#include "storage/backup.h"

#include <SQLiteCpp/Backup.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/connection.h"
#include "storage/schema.h"

namespace homing::storage {
namespace {

namespace fs = std::filesystem;

absl::Status Copy(Connection& from, const std::string& to) {
  HOMING_ASSIGN_OR_RETURN(const auto copy,
                          Connection::Open(to, Connection::Access::kReadWrite, kBusyTimeoutMs));
  return copy->Run([&]() -> absl::Status {
    HOMING_RETURN_IF_ERROR(CheckOwnFile(from));
    copy->Execute("PRAGMA synchronous=FULL");
    // All pages in one step, that is in one read transaction: writes by the server never restart
    // it.
    SQLite::Backup backup(copy->database(), from.database());
    backup.executeStep();
    const std::string check = copy->Text("PRAGMA quick_check(1)");
    if (check == "ok") return absl::OkStatus();
    return absl::DataLossError(absl::StrCat("store: the copy is damaged: ", check));
  });
}

// Makes the new name durable.
absl::Status SyncFolder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (synced) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("backup: cannot sync '", folder.string(), "': ", std::strerror(error)));
}

void RemovePartial(const std::string& partial) {
  std::error_code ignored;
  for (const char* end : {"", "-journal", "-wal", "-shm"}) fs::remove(partial + end, ignored);
}

absl::Status GiveName(const std::string& partial, const std::string& to) {
  // Unlike rename, this never replaces a file.
  if (::link(partial.c_str(), to.c_str()) != 0) {
    const int error = errno;
    const std::string message =
        absl::StrCat("backup: cannot make '", to, "': ", std::strerror(error));
    return error == EEXIST ? absl::AlreadyExistsError(message)
                           : absl::FailedPreconditionError(message);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status BackUp(const std::string& path, const std::string& to) {
  if (fs::exists(to)) {
    return absl::AlreadyExistsError(absl::StrCat("'", to, "' exists; name a new file"));
  }
  HOMING_ASSIGN_OR_RETURN(const auto from, OpenForReading(path, kBusyTimeoutMs));
  const std::string partial = to + ".partial";
  RemovePartial(partial);
  absl::Status status = Copy(*from, partial);
  if (status.ok()) status = GiveName(partial, to);
  RemovePartial(partial);
  HOMING_RETURN_IF_ERROR(status);
  return SyncFolder(to);
}

absl::StatusOr<std::unique_ptr<std::istream>> CopyForReading(const std::string& path,
                                                             const std::string& by) {
  std::error_code error;
  fs::remove(by, error);
  // The copy must leave room for recording: the file, its log and a margin.
  const std::uintmax_t room = fs::space(fs::absolute(path).parent_path(), error).available;
  std::uintmax_t needed = fs::file_size(path, error);
  const std::uintmax_t log = fs::file_size(path + "-wal", error);
  needed += error ? 0 : log;
  if (needed > room - room / 10) {
    return absl::ResourceExhaustedError(absl::StrCat(
        "store: a copy takes ", needed, " bytes beside the database; ", room, " are free"));
  }
  HOMING_RETURN_IF_ERROR(BackUp(path, by));
  auto copy = std::make_unique<std::ifstream>(by, std::ios::binary);
  fs::remove(by, error);
  if (!*copy) {
    return absl::UnavailableError(absl::StrCat("store: the copy '", by, "' cannot be read"));
  }
  return copy;
}

}  // namespace homing::storage
