// A growing array whose elements never move: each growth costs the same.
#ifndef HOMING_MATCHING_CHUNKED_ARRAY_H_
#define HOMING_MATCHING_CHUNKED_ARRAY_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace homing {

// kChunk elements are allocated at a time; a power of two. Not thread-safe.
template <typename T, std::size_t kChunk>
class ChunkedArray {
 public:
  static_assert((kChunk & (kChunk - 1)) == 0);

  std::uint32_t size() const { return size_; }
  T& operator[](std::uint32_t i) { return chunks_[i / kChunk][i % kChunk]; }
  const T& operator[](std::uint32_t i) const { return chunks_[i / kChunk][i % kChunk]; }
  // Returns the index of the new element.
  std::uint32_t Add(const T& value) {
    if (size_ % kChunk == 0) {
      chunks_.push_back(std::make_unique<T[]>(kChunk));
    }
    (*this)[size_] = value;
    return size_++;
  }
  std::size_t MemoryBytes() const {
    return chunks_.size() * kChunk * sizeof(T) + chunks_.capacity() * sizeof(chunks_[0]);
  }

 private:
  std::vector<std::unique_ptr<T[]>> chunks_;
  std::uint32_t size_ = 0;
};

}  // namespace homing

#endif  // HOMING_MATCHING_CHUNKED_ARRAY_H_
