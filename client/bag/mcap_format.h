// Words of the MCAP format. Source: the format's public specification (mcap.dev/spec).
#ifndef CLIENT_BAG_MCAP_FORMAT_H_
#define CLIENT_BAG_MCAP_FORMAT_H_

#include <cstdint>
#include <string_view>

namespace homing::client::bag {

// The bytes at the beginning and at the end of a file.
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

// The byte before each record, followed by the record's length in eight bytes.
namespace mcap_opcode {
inline constexpr std::uint8_t kHeader = 0x01;
inline constexpr std::uint8_t kFooter = 0x02;
inline constexpr std::uint8_t kSchema = 0x03;
inline constexpr std::uint8_t kChannel = 0x04;
inline constexpr std::uint8_t kMessage = 0x05;
inline constexpr std::uint8_t kChunk = 0x06;
inline constexpr std::uint8_t kMessageIndex = 0x07;
inline constexpr std::uint8_t kChunkIndex = 0x08;
inline constexpr std::uint8_t kStatistics = 0x0B;
inline constexpr std::uint8_t kDataEnd = 0x0F;
}  // namespace mcap_opcode

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_MCAP_FORMAT_H_
