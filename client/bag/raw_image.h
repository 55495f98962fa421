// Converts pixels as robots record them to encodings that the server accepts. Source: the names of
// encodings in sensor_msgs.
#ifndef CLIENT_BAG_RAW_IMAGE_H_
#define CLIENT_BAG_RAW_IMAGE_H_

#include <cstdint>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client::bag {

// Does not own its bytes.
struct RawImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  // Bytes from row to row.
  std::uint32_t step = 0;
  std::string_view encoding;
  bool big_endian = false;
  std::string_view data;
};

// Grey stays grey; 16 bit is stretched as in a PNG file; of YUV the Y is taken; Bayer patterns
// become grey; alpha is dropped. INVALID_ARGUMENT: another encoding, or fewer bytes than it needs.
absl::StatusOr<SourceFrame> ConvertRawImage(const RawImage& image);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_RAW_IMAGE_H_
