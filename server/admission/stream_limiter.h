// Counts open streams, in total and of each robot.
#ifndef SERVER_ADMISSION_STREAM_LIMITER_H_
#define SERVER_ADMISSION_STREAM_LIMITER_H_

#include <map>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"

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

  // 0: no limit.
  StreamLimiter(int max_all, int max_robot) : max_all_(max_all), max_robot_(max_robot) {}

  // `robot` empty: the stream counts in the total only. RESOURCE_EXHAUSTED naming the limit. The
  // last quarter of all is for robots with fewer than 16, so that one cannot keep out the others.
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
