// Reads numbers and texts from bytes in memory; never beyond their end.
#ifndef CLIENT_BAG_BYTE_READER_H_
#define CLIENT_BAG_BYTE_READER_H_

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace homing::client::bag {

// After the first read beyond the end, ok() is false and every read gives zeros and empty texts. So
// a caller reads a whole record and checks once. Does not own the bytes. Not thread-safe.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool empty() const { return offset_ == bytes_.size(); }
  std::size_t offset() const { return offset_; }
  std::size_t rest() const { return bytes_.size() - offset_; }
  // Numbers are little endian unless this is set.
  void set_big_endian(bool big_endian) { big_endian_ = big_endian; }

  std::string_view Bytes(std::uint64_t count) {
    if (count > rest()) ok_ = false;
    if (!ok_) return {};
    const std::string_view bytes = bytes_.substr(offset_, static_cast<std::size_t>(count));
    offset_ += bytes.size();
    return bytes;
  }

  template <typename Number>
  requires std::integral<Number> || std::floating_point<Number> Number Take() {
    const std::string_view bytes = Bytes(sizeof(Number));
    if (bytes.empty()) return Number{};
    std::array<char, sizeof(Number)> raw{};
    std::copy(bytes.begin(), bytes.end(), raw.begin());
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    Number number;
    std::memcpy(&number, raw.data(), raw.size());
    return number;
  }

  // A length of four bytes, then so many bytes.
  std::string_view Text() { return Bytes(Take<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  std::size_t offset_ = 0;
  bool ok_ = true;
  bool big_endian_ = false;
};

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_BYTE_READER_H_
