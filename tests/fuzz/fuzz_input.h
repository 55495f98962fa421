// Reads the input of libFuzzer piece by piece. Missing bytes are 0.
#ifndef TESTS_FUZZ_FUZZ_INPUT_H_
#define TESTS_FUZZ_FUZZ_INPUT_H_

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

namespace homing::fuzz {

class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size)
      : rest_(reinterpret_cast<const char*>(data), size) {}

  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

  template <typename Number>
  Number Take() {
    Number number{};
    const std::size_t size = std::min(sizeof(number), rest_.size());
    std::memcpy(&number, rest_.data(), size);
    rest_.remove_prefix(size);
    return number;
  }
  std::string_view TakeBytes(std::size_t count) {
    const std::string_view bytes = rest_.substr(0, count);
    rest_.remove_prefix(bytes.size());
    return bytes;
  }

 private:
  std::string_view rest_;
};

// The input as a new file in memory; its path, the same each time.
inline std::string FileOf(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/dev/shm/homing_fuzz_file_" + std::to_string(::getpid());
  ::unlink(path.c_str());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

// A condition that must hold; the fuzzer sees an abort.
inline void Require(bool holds) {
  if (!holds) __builtin_trap();
}

}  // namespace homing::fuzz

#endif  // TESTS_FUZZ_FUZZ_INPUT_H_
