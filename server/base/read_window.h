// How far a stream may read ahead of its answers.
#ifndef SERVER_BASE_READ_WINDOW_H_
#define SERVER_BASE_READ_WINDOW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace homing::server {

// The requests that were read and are not yet answered, in order. Not thread-safe.
class ReadWindow {
 public:
  // Enough that many observations share one commit. For frames, kMaxBytes is reached first.
  static constexpr std::size_t kMaxRequests = 256;
  static constexpr std::size_t kMaxBytes = 1 << 20;

  void Add(std::size_t request_bytes) {
    sizes_.push_back(request_bytes);
    bytes_ += request_bytes;
  }
  // The oldest request was answered. Does nothing when there is none.
  void MarkAnswered() {
    if (!sizes_.empty()) {
      bytes_ -= sizes_.front();
      sizes_.erase(sizes_.begin());
    }
  }
  // No further request may be read: `max_requests` are not answered or have an answer among the
  // `unsent` ones, or their bytes reach kMaxBytes.
  bool IsFull(std::size_t unsent, std::size_t max_requests) const {
    return sizes_.size() + unsent >= max_requests || bytes_ >= kMaxBytes;
  }
  bool IsEmpty() const { return sizes_.empty(); }
  // Bytes of the requests; 0 up to kMaxBytes, which each stream may have.
  std::int64_t large_bytes() const {
    return bytes_ > kMaxBytes ? static_cast<std::int64_t>(bytes_) : 0;
  }

 private:
  // A vector and not a deque: an empty deque takes 600 bytes, and there are many streams.
  std::vector<std::size_t> sizes_;
  std::size_t bytes_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_BASE_READ_WINDOW_H_
