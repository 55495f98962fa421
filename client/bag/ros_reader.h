// Fields of ROS messages in the order of their definition, as ROS 1 or CDR. Source: the public
// descriptions of both.
#ifndef CLIENT_BAG_ROS_READER_H_
#define CLIENT_BAG_ROS_READER_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "client/bag/bag.h"
#include "client/bag/byte_reader.h"

namespace homing::client::bag {

// As ByteReader: a read beyond the end gives 0 or empty, and ok() is then false. Does not own the
// bytes. Not thread-safe.
class RosReader {
 public:
  RosReader(Wire wire, std::string_view bytes)
      : cdr_(wire == Wire::kCdr), reader_(cdr_ ? AfterHead(bytes) : bytes) {
    if (!cdr_) return;
    // 00 00: big endian, 00 01: little endian; other encapsulations are not read.
    known_ = bytes.size() >= kHeadBytes && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
    reader_.set_big_endian(known_ && bytes[1] == 0);
  }

  bool ok() const { return known_ && reader_.ok(); }

  template <typename Number>
  Number Take() {
    if (cdr_) reader_.Bytes(-reader_.offset() % sizeof(Number));
    return reader_.Take<Number>();
  }
  std::string_view Text() {
    std::string_view text = Bytes();
    // CDR counts the terminating zero.
    if (cdr_ && !text.empty() && text.back() == '\0') text.remove_suffix(1);
    return text;
  }
  // A sequence of bytes.
  std::string_view Bytes() { return reader_.Bytes(Take<std::uint32_t>()); }
  std::vector<double> Doubles(std::uint64_t count) {
    std::vector<double> values;
    while (ok() && values.size() < count) values.push_back(Take<double>());
    return values;
  }
  // std_msgs/Header; its stamp in nanoseconds.
  std::int64_t Header() {
    if (!cdr_) Take<std::uint32_t>();
    const auto seconds = Take<std::uint32_t>();
    const auto nanoseconds = Take<std::uint32_t>();
    Text();
    return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
  }

 private:
  static constexpr std::size_t kHeadBytes = 4;

  static std::string_view AfterHead(std::string_view bytes) {
    return bytes.size() < kHeadBytes ? std::string_view() : bytes.substr(kHeadBytes);
  }

  bool cdr_;
  bool known_ = true;
  ByteReader reader_;
};

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_ROS_READER_H_
