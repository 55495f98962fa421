#include "homing/image/orientation.h"

#include <cstdint>
#include <optional>

namespace homing {
namespace {

constexpr int kUpright = 1;
constexpr std::string_view kExifHead("Exif\0\0", 6);

// The unsigned number of `count` bytes at `at`; nothing beyond the end.
std::optional<std::size_t> Number(std::string_view bytes, std::size_t at, std::size_t count,
                                  bool big_endian) {
  if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = big_endian ? at + i : at + count - 1 - i;
    value = value << 8U | static_cast<unsigned char>(bytes[index]);
  }
  return value;
}

// The orientation tag (0x0112, one SHORT) in the first directory of a TIFF header.
int OrientationInTiff(std::string_view tiff) {
  if (tiff.substr(0, kExifHead.size()) == kExifHead) tiff.remove_prefix(kExifHead.size());
  const bool big = tiff.substr(0, 2) == "MM";
  if (!big && tiff.substr(0, 2) != "II") return kUpright;
  const auto directory = Number(tiff, 4, 4, big);
  if (!directory) return kUpright;
  const auto entries = Number(tiff, *directory, 2, big);
  for (std::size_t i = 0; entries && i < *entries; ++i) {
    const std::size_t entry = *directory + 2 + 12 * i;
    const auto tag = Number(tiff, entry, 2, big);
    const auto value = Number(tiff, entry + 8, 2, big);
    if (!tag || !value) break;
    if (*tag == 0x0112) return *value >= 1 && *value <= 8 ? static_cast<int>(*value) : kUpright;
  }
  return kUpright;
}

// Segments up to the first scan: FF, kind, length of what follows.
std::string_view ExifOfJpeg(std::string_view file) {
  std::size_t at = 2;
  while (true) {
    const auto marker = Number(file, at, 2, true);
    if (!marker || *marker >> 8U != 0xFF || *marker == 0xFFDA) return {};
    if (*marker == 0xFFFF) {  // A fill byte.
      ++at;
      continue;
    }
    const auto length = Number(file, at + 2, 2, true);
    if (!length || *length < 2) return {};
    const std::string_view body = file.substr(at + 4, *length - 2);
    if (*marker == 0xFFE1 && body.substr(0, kExifHead.size()) == kExifHead) return body;
    at += 2 + *length;
    if (at > file.size()) return {};
  }
}

// Chunks: in PNG length, kind, body, checksum; in WebP (RIFF) kind, length, body, padded to even.
std::string_view ExifOfChunks(std::string_view file, std::size_t at, bool png) {
  while (true) {
    const auto length = Number(file, png ? at : at + 4, 4, png);
    if (!length || at + 8 > file.size()) return {};
    const std::string_view kind = file.substr(png ? at + 4 : at, 4);
    if (kind == (png ? "eXIf" : "EXIF")) return file.substr(at + 8, *length);
    if (*length > file.size()) return {};
    at += png ? 12 + *length : 8 + *length + *length % 2;
    if (at > file.size()) return {};
  }
}

}  // namespace

int ExifOrientation(std::string_view file) {
  if (file.substr(0, 2) == "\xFF\xD8") return OrientationInTiff(ExifOfJpeg(file));
  if (file.substr(0, 4) == "\x89PNG") return OrientationInTiff(ExifOfChunks(file, 8, true));
  if (file.substr(0, 4) == "RIFF" && file.size() >= 12 && file.substr(8, 4) == "WEBP") {
    return OrientationInTiff(ExifOfChunks(file, 12, false));
  }
  return kUpright;
}

cv::Mat TurnUpright(const cv::Mat& image, int orientation) {
  if (orientation < 2 || orientation > 8) return image;
  cv::Mat upright = image;
  // Orientations 5 to 8 are mirrored along the diagonal first.
  if (ExchangesSides(orientation)) cv::transpose(image, upright);
  constexpr int kLeftRight = 1;
  constexpr int kUpDown = 0;
  constexpr int kBoth = -1;
  cv::Mat result;
  switch (orientation) {
    case 2:
    case 6:
      cv::flip(upright, result, kLeftRight);
      return result;
    case 3:
    case 7:
      cv::flip(upright, result, kBoth);
      return result;
    case 4:
    case 8:
      cv::flip(upright, result, kUpDown);
      return result;
    default:
      return upright;
  }
}

}  // namespace homing
