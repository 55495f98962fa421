// A disk with faults between a program and the C library (LD_PRELOAD), for the calls SQLite makes.
// Environment:
//   FAULTY_DISK_DIR      the folder watched (a real path); other files are left alone
//   FAULTY_DISK_LOG      where to record what was asked (disk_log.h), for power_cut.cc. Syncs then
//                        return at once, or after FAULTY_DISK_SYNC_MS as from a disk that takes
//                        its time: the record says what is on the disk, not the machine
//   FAULTY_DISK_CONTROL  a folder; a file of one of these names in it makes it happen while it is
//                        there: full, read-only (writes fail ENOSPC, EROFS), bad-write, bad-read,
//                        bad-sync (EIO), lie (syncs are not recorded), clock (its text is the
//                        number of seconds that the wall clock is wrong by)
// Files ending in -shm and -lock are memory and locks: not recorded.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>

#include "tests/faults/disk_log.h"

namespace homing::faults {
namespace {

constexpr char kTheFolder[] = ".";

template <typename Function>
Function Real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

struct Disk {
  std::mutex mutex;
  std::string folder;
  std::string control;
  useconds_t sync_us = 0;
  int log = -1;
  // Name within the folder of each open descriptor; empty: not watched.
  std::array<std::string, 4096> names;

  Disk() {
    const auto text = [](const char* name) {
      const char* value = std::getenv(name);
      return std::string(value == nullptr ? "" : value);
    };
    folder = text("FAULTY_DISK_DIR");
    control = text("FAULTY_DISK_CONTROL");
    sync_us = static_cast<useconds_t>(std::atoi(text("FAULTY_DISK_SYNC_MS").c_str()) * 1000);
    const std::string path = text("FAULTY_DISK_LOG");
    if (!path.empty()) {
      static const auto real = Real<int (*)(const char*, int, ...)>("open64");
      log = real(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    }
  }

  bool Is(const char* fault) const {
    return !control.empty() && ::access((control + "/" + fault).c_str(), F_OK) == 0;
  }
};

Disk& TheDisk() {
  // Never destroyed: files are closed after the statics are gone.
  static Disk* const disk = new Disk;
  return *disk;
}

bool EndsWith(const std::string& text, const char* end) {
  const std::size_t size = std::strlen(end);
  return text.size() >= size && text.compare(text.size() - size, size, end) == 0;
}

bool IsRecorded(const std::string& name) {
  return TheDisk().log >= 0 && !name.empty() && !EndsWith(name, "-shm") && !EndsWith(name, "-lock");
}

// The name within the folder; "." the folder itself; empty: elsewhere.
std::string NameOf(const char* path) {
  const std::string& folder = TheDisk().folder;
  const std::string text = path;
  if (folder.empty() || text.compare(0, folder.size(), folder) != 0) return {};
  if (text.size() == folder.size()) return kTheFolder;
  return text[folder.size()] == '/' ? text.substr(folder.size() + 1) : std::string();
}

std::string NameOf(int file) {
  Disk& disk = TheDisk();
  if (file < 0 || file >= static_cast<int>(disk.names.size())) return {};
  const std::lock_guard lock(disk.mutex);
  return disk.names[static_cast<std::size_t>(file)];
}

void SetName(int file, const std::string& name) {
  Disk& disk = TheDisk();
  if (file < 0 || file >= static_cast<int>(disk.names.size())) return;
  const std::lock_guard lock(disk.mutex);
  disk.names[static_cast<std::size_t>(file)] = name;
}

// One write call a record, so that a kill leaves at most the last one incomplete.
void Record(DiskOp op, const std::string& name, std::int64_t offset = 0,
            const void* bytes = nullptr, std::size_t size = 0) {
  const DiskRecord header{op, static_cast<std::uint32_t>(name.size()), offset,
                          static_cast<std::int64_t>(size)};
  std::string record(reinterpret_cast<const char*>(&header), sizeof(header));
  record += name;
  if (size > 0) record.append(static_cast<const char*>(bytes), size);
  static const auto real = Real<ssize_t (*)(int, const void*, std::size_t)>("write");
  const std::lock_guard lock(TheDisk().mutex);
  if (real(TheDisk().log, record.data(), record.size()) != static_cast<ssize_t>(record.size())) {
    std::abort();
  }
}

int Fail(int error) {
  errno = error;
  return -1;
}

// 0, or the error that a change of a watched file meets.
int WriteFault(const std::string& name) {
  if (name.empty()) return 0;
  if (TheDisk().Is("full")) return ENOSPC;
  if (TheDisk().Is("read-only")) return EROFS;
  return TheDisk().Is("bad-write") ? EIO : 0;
}

int Opened(int file, const char* path, bool existed) {
  const std::string name = NameOf(path);
  if (file >= 0 && !name.empty()) {
    SetName(file, name);
    if (!existed && IsRecorded(name)) Record(DiskOp::kCreate, name);
  }
  return file;
}

int Open(const char* symbol, const char* path, int flags, mode_t mode) {
  const auto real = Real<int (*)(const char*, int, ...)>(symbol);
  const bool watched = !NameOf(path).empty();
  const bool existed = !watched || ::access(path, F_OK) == 0;
  if (!existed && (flags & O_CREAT) != 0) {
    if (const int error = WriteFault(NameOf(path)); error != 0) return Fail(error);
  }
  return Opened(real(path, flags, mode), path, existed);
}

int Sync(const char* symbol, int file) {
  const std::string name = NameOf(file);
  if (!name.empty() && TheDisk().Is("bad-sync")) return Fail(EIO);
  if (!IsRecorded(name)) return Real<int (*)(int)>(symbol)(file);
  ::usleep(TheDisk().sync_us);
  if (!TheDisk().Is("lie")) {
    Record(name == kTheFolder ? DiskOp::kSyncNames : DiskOp::kSync, name);
  }
  return 0;
}

}  // namespace
}  // namespace homing::faults

// The functions of the C library, by their own names.
using homing::faults::DiskOp;
using homing::faults::Fail;
using homing::faults::IsRecorded;
using homing::faults::NameOf;
using homing::faults::Real;
using homing::faults::TheDisk;

extern "C" {

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = static_cast<mode_t>(va_arg(rest, unsigned));
  va_end(rest);
  return homing::faults::Open("open64", path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = static_cast<mode_t>(va_arg(rest, unsigned));
  va_end(rest);
  return homing::faults::Open("open", path, flags, mode);
}

int close(int file) {
  homing::faults::SetName(file, {});
  static const auto real = Real<int (*)(int)>("close");
  return real(file);
}

ssize_t pwrite64(int file, const void* bytes, std::size_t size, off64_t offset) {
  static const auto real = Real<ssize_t (*)(int, const void*, std::size_t, off64_t)>("pwrite64");
  const std::string name = NameOf(file);
  if (const int error = homing::faults::WriteFault(name); error != 0) return Fail(error);
  if (IsRecorded(name)) homing::faults::Record(DiskOp::kWrite, name, offset, bytes, size);
  return real(file, bytes, size, offset);
}

ssize_t pread64(int file, void* bytes, std::size_t size, off64_t offset) {
  static const auto real = Real<ssize_t (*)(int, void*, std::size_t, off64_t)>("pread64");
  const std::string name = NameOf(file);
  if (!name.empty() && TheDisk().Is("bad-read")) return Fail(EIO);
  return real(file, bytes, size, offset);
}

int ftruncate64(int file, off64_t size) noexcept {
  static const auto real = Real<int (*)(int, off64_t)>("ftruncate64");
  const std::string name = NameOf(file);
  if (const int error = homing::faults::WriteFault(name); error != 0) return Fail(error);
  if (IsRecorded(name)) homing::faults::Record(DiskOp::kTruncate, name, size);
  return real(file, size);
}

int unlink(const char* path) noexcept {
  static const auto real = Real<int (*)(const char*)>("unlink");
  const std::string name = NameOf(path);
  if (!name.empty() && TheDisk().Is("read-only")) return Fail(EROFS);
  const int result = real(path);
  if (result == 0 && IsRecorded(name)) homing::faults::Record(DiskOp::kUnlink, name);
  return result;
}

int fsync(int file) { return homing::faults::Sync("fsync", file); }
int fdatasync(int file) { return homing::faults::Sync("fdatasync", file); }

int clock_gettime(clockid_t clock, struct timespec* time) noexcept {
  static const auto real = Real<int (*)(clockid_t, struct timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (result != 0 || clock != CLOCK_REALTIME || TheDisk().control.empty()) return result;
  static const auto open_file = Real<int (*)(const char*, int, ...)>("open64");
  const int file = open_file((TheDisk().control + "/clock").c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return result;
  std::array<char, 32> text{};
  const ssize_t size = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  if (size > 0) time->tv_sec += std::atol(text.data());
  return result;
}

}  // extern "C"
