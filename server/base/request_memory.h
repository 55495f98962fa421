// The memory of requests that wait for a worker.
#ifndef SERVER_BASE_REQUEST_MEMORY_H_
#define SERVER_BASE_REQUEST_MEMORY_H_

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {

// Callers share `most` bytes, 0: no limit. Each has at most a quarter, so that nobody can take them
// all. A caller's only request is always taken while the whole is not full: its size has a limit
// already. Thread-safe.
class RequestMemory {
 public:
  explicit RequestMemory(std::int64_t most) : most_(most) {}

  std::int64_t most() const { return most_; }

  // The part of one call or stream, given back at the end. Not thread-safe.
  class Share {
   public:
    Share(std::shared_ptr<RequestMemory> memory, std::string caller)
        : memory_(std::move(memory)), caller_(std::move(caller)) {}
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share() { TrySet(0); }

    // False, and no change: more than the limits.
    bool TrySet(std::int64_t bytes) {
      if (bytes == bytes_) return true;
      if (!memory_->TryAdd(caller_, bytes - bytes_)) return false;
      bytes_ = bytes;
      return true;
    }

   private:
    const std::shared_ptr<RequestMemory> memory_;
    const std::string caller_;
    std::int64_t bytes_ = 0;
  };

 private:
  static constexpr std::int64_t kCallersPart = 4;

  bool TryAdd(const std::string& caller, std::int64_t bytes) {
    const MutexLock lock(mutex_);
    std::int64_t& of_caller = of_caller_[caller];
    const bool all_full = used_ > 0 && used_ + bytes > most_;
    const bool caller_full = of_caller > 0 && of_caller + bytes > most_ / kCallersPart;
    const bool taken = bytes <= 0 || most_ == 0 || !(all_full || caller_full);
    if (taken) {
      used_ += bytes;
      of_caller += bytes;
    }
    if (of_caller == 0) of_caller_.erase(caller);
    return taken;
  }

  const std::int64_t most_;
  Mutex mutex_;
  std::int64_t used_ HOMING_GUARDED_BY(mutex_) = 0;
  std::unordered_map<std::string, std::int64_t> of_caller_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_BASE_REQUEST_MEMORY_H_
