// A JPEG of a real picture, and PNG headers with false sizes.
#ifndef TESTS_SERVER_COMPRESSED_IMAGES_H_
#define TESTS_SERVER_COMPRESSED_IMAGES_H_

#include <turbojpeg.h>
#include <zlib.h>

#include <cstdint>
#include <string>

#include "tests/support/route.h"

namespace homing::server {

inline std::string Jpeg() {
  const std::string gray = test::WallAt(0, Side::kLeft);
  tjhandle compressor = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(compressor, reinterpret_cast<const unsigned char*>(gray.data()), test::kWidth, 0,
              test::kHeight, TJPF_GRAY, &bytes, &size, TJSAMP_GRAY, 90, 0);
  std::string jpeg(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(compressor);
  return jpeg;
}

inline std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>(value >> shift));
  }
  return bytes;
}

inline std::string PngChunk(const std::string& type_and_content) {
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(type_and_content.data()),
                         static_cast<uInt>(type_and_content.size()));
  return BigEndian(static_cast<std::uint32_t>(type_and_content.size() - 4)) + type_and_content +
         BigEndian(static_cast<std::uint32_t>(crc));
}

inline std::string PngThatClaims(std::uint32_t width, std::uint32_t height) {
  const std::string header =
      "IHDR" + BigEndian(width) + BigEndian(height) + std::string("\x08\x00\x00\x00\x00", 5);
  return "\x89PNG\r\n\x1a\n" + PngChunk(header) + PngChunk("IDATx") + PngChunk("IEND");
}

}  // namespace homing::server

#endif  // TESTS_SERVER_COMPRESSED_IMAGES_H_
