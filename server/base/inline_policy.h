// Decides where a stream handles its next request: on the thread that read it, or in the worker
// pool.
#ifndef SERVER_BASE_INLINE_POLICY_H_
#define SERVER_BASE_INLINE_POLICY_H_

#include <atomic>
#include <chrono>
#include <cstddef>

namespace homing::server {

// One thread at a time calls NoteWait; the other functions are thread-safe.
class InlinePolicy {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Requests up to this size run inline if the previous one took less than kQuick: waking a worker
  // costs more.
  static constexpr std::size_t kInlineBytes = 65536;
  static constexpr std::chrono::microseconds kQuick{1000};
  // Longer than most answers take.
  static constexpr std::chrono::milliseconds kLongWait{5};

  bool RunsInline(std::size_t request_bytes) const {
    return quick_ && request_bytes <= kInlineBytes;
  }
  void NoteHandled(Duration time) { quick_ = time < kQuick; }

  // A request was read after a wait of `waited`. True: this wait and the one before were long, so
  // the next request is not there yet. A read that starts after the answer then lets gRPC put the
  // window update into the answer's packet. Two waits, because more requests are queued behind the
  // first one of a burst.
  bool NoteWait(Duration waited) {
    const bool was_long = last_wait_was_long_;
    last_wait_was_long_ = waited > kLongWait;
    return was_long && last_wait_was_long_;
  }

 private:
  std::atomic<bool> quick_ = false;
  bool last_wait_was_long_ = false;
};

}  // namespace homing::server

#endif  // SERVER_BASE_INLINE_POLICY_H_
