// Counts open streams, in total and of each robot.
#ifndef SERVER_ADMISSION_STREAM_LIMITER_H_
#define SERVER_ADMISSION_STREAM_LIMITER_H_

#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "server/admission/limits.h"

namespace homing::server {

// Thread-safe.
class StreamLimiter {
 public:
  // Holds the slot of one open stream; the destructor frees it.
  class Slot {
   public:
    Slot() = default;
    Slot(StreamLimiter* limiter, std::string robot);
    Slot(Slot&& other) noexcept;
    Slot& operator=(Slot&& other) noexcept;
    ~Slot() { Leave(); }
    void Leave();

   private:
    StreamLimiter* limiter_ = nullptr;
    std::string robot_;
  };

  explicit StreamLimiter(const Limits& limits)
      : max_all_(limits.max_streams), max_robot_(limits.max_robot_streams) {}

  // `robot` empty: the stream counts in the total only. RESOURCE_EXHAUSTED naming the limit.
  absl::StatusOr<Slot> Enter(const std::string& robot);
  int open() const;

 private:
  void Leave(const std::string& robot);

  const int max_all_;
  const int max_robot_;
  mutable Mutex mutex_;
  int open_ HOMING_GUARDED_BY(mutex_) = 0;
  std::map<std::string, int> of_robot_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_STREAM_LIMITER_H_
