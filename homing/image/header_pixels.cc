#include "homing/image/header_pixels.h"

#include <string_view>

namespace homing {
namespace {

// The big-endian number of `count` bytes at `at`; -1 beyond the end.
std::int64_t Number(std::string_view bytes, std::size_t at, std::size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return -1;
  std::int64_t value = 0;
  for (std::size_t i = at; i < at + count; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

std::optional<std::int64_t> Product(std::int64_t width, std::int64_t height) {
  if (width < 0 || height < 0) return std::nullopt;
  return width * height;
}

bool IsFrameHeader(std::int64_t marker) {
  return marker >= 0xFFC0 && marker <= 0xFFCF && marker != 0xFFC4 && marker != 0xFFC8 &&
         marker != 0xFFCC;
}

// Segments up to the frame header: FF, kind, length of what follows.
std::optional<std::int64_t> PixelsOfJpeg(std::string_view file) {
  std::size_t at = 2;
  while (true) {
    const std::int64_t marker = Number(file, at, 2);
    if (marker == 0xFFFF) {  // A fill byte.
      ++at;
      continue;
    }
    if (IsFrameHeader(marker)) return Product(Number(file, at + 7, 2), Number(file, at + 5, 2));
    const std::int64_t length = Number(file, at + 2, 2);
    if (marker >> 8 != 0xFF || length < 2) return std::nullopt;
    at += 2 + static_cast<std::size_t>(length);
  }
}

}  // namespace

std::optional<std::int64_t> HeaderPixels(const Frame& frame) {
  switch (frame.encoding) {
    case FrameEncoding::kGray8:
    case FrameEncoding::kRgb8:
    case FrameEncoding::kBgr8:
      return Product(frame.width, frame.height);
    case FrameEncoding::kJpeg:
      return PixelsOfJpeg(frame.data);
    case FrameEncoding::kPng:
      // After the signature, the chunk's length and its name.
      return Product(Number(frame.data, 16, 4), Number(frame.data, 20, 4));
  }
  return std::nullopt;
}

}  // namespace homing
