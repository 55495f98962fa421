#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "homing/image/frame.h"
#include "tests/homing/image/encoded_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using enum FrameEncoding;

cv::Mat Picture() {
  cv::Mat image(48, 64, CV_8UC1);
  cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

std::string Jpeg() { return EncodeJpeg(Picture()); }
std::string Png() { return EncodePng(Picture(), {SPNG_COLOR_TYPE_GRAYSCALE, 8}); }

// A JPEG or PNG whose header claims another size; the PNG's checksum is made right.
std::string JpegClaiming(int width, int height) {
  std::string bytes = Jpeg();
  const std::size_t frame = bytes.find(std::string("\xFF\xC0", 2));
  const auto put = [&bytes](std::size_t at, int value) {
    bytes[at] = static_cast<char>(value >> 8);
    bytes[at + 1] = static_cast<char>(value & 255);
  };
  put(frame + 5, height);
  put(frame + 7, width);
  return bytes;
}

std::uint32_t Crc(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

std::string PngClaiming(std::uint32_t width, std::uint32_t height) {
  std::string bytes = Png();
  const auto put = [&bytes](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[at + i] = static_cast<char>((value >> (24 - 8 * i)) & 255U);
    }
  };
  put(16, width);
  put(20, height);
  put(29, Crc(bytes.substr(12, 17)));
  return bytes;
}

struct BadFrame {
  std::string name;
  FrameEncoding encoding;
  int width;
  int height;
  std::string data;
  std::string message;
};

std::vector<BadFrame> BadFrames() {
  const std::string pixels(64 * 48, 'x');
  constexpr int kHuge = std::numeric_limits<int>::max();
  return {
      {"GrayTooShort", kGray8, 64, 48, pixels.substr(1), "frame.data: 3071"},
      {"GrayTooLong", kGray8, 64, 48, pixels + "x", "3072 bytes"},
      {"RgbOfGrayLength", kRgb8, 64, 48, pixels, "9216 bytes"},
      {"BgrOfGrayLength", kBgr8, 64, 48, pixels, "9216 bytes"},
      {"GrayEmpty", kGray8, 64, 48, "", "frame.data: 0"},
      {"WidthZero", kGray8, 0, 48, pixels, "frame.width: 0 must be in [16, 8192] px"},
      {"HeightZero", kGray8, 64, 0, pixels, "frame.height: 0 must be in"},
      {"WidthNegative", kGray8, -64, 48, pixels, "frame.width: -64"},
      {"WidthHuge", kRgb8, kHuge, 48, pixels, "frame.width: 2147483647"},
      {"HeightHuge", kRgb8, 64, kHuge, pixels, "frame.height: 2147483647"},
      {"TooManyPixels", kGray8, 8000, 8000, pixels, "at most 16777216 pixels"},
      {"UnknownEncoding", static_cast<FrameEncoding>(17), 64, 48, pixels, "frame.encoding: 17"},
      {"JpegHalf", kJpeg, 0, 0, Jpeg().substr(0, Jpeg().size() / 2), "not a complete JPEG"},
      {"JpegWithoutLastBytes", kJpeg, 0, 0, Jpeg().substr(0, Jpeg().size() - 40), "JPEG"},
      {"JpegHeaderOnly", kJpeg, 0, 0, Jpeg().substr(0, 20), "not a complete JPEG"},
      {"JpegEmpty", kJpeg, 0, 0, "", "not a complete JPEG"},
      {"JpegIsPng", kJpeg, 0, 0, Png(), "not a complete JPEG"},
      {"JpegOtherWidth", kJpeg, 63, 48, Jpeg(), "frame.width: 63 must be 0 or the image header"},
      {"JpegOtherHeight", kJpeg, 64, 49, Jpeg(), "frame.height: 49 must be"},
      {"JpegNegativeWidth", kJpeg, -64, 48, Jpeg(), "frame.width: -64 must be"},
      {"JpegClaimsHuge", kJpeg, 0, 0, JpegClaiming(60000, 60000), "frame.width: 60000"},
      {"JpegClaimsMoreRows", kJpeg, 0, 0, JpegClaiming(64, 480), "not a complete JPEG"},
      {"PngHalf", kPng, 0, 0, Png().substr(0, Png().size() / 2), "not a complete PNG"},
      {"PngWithoutEnd", kPng, 0, 0, Png().substr(0, Png().size() - 12), "not a complete PNG"},
      {"PngHeaderOnly", kPng, 0, 0, Png().substr(0, 33), "not a complete PNG"},
      {"PngEmpty", kPng, 0, 0, "", "not a complete PNG"},
      {"PngIsJpeg", kPng, 0, 0, Jpeg(), "not a complete PNG"},
      {"PngOtherWidth", kPng, 65, 48, Png(), "frame.width: 65 must be 0 or the image header"},
      {"PngBomb", kPng, 0, 0, PngClaiming(60000, 60000), "frame.width: 60000 must be in"},
      {"PngAreaBomb", kPng, 0, 0, PngClaiming(8192, 8192), "at most 16777216 pixels"},
      {"PngTiny", kPng, 0, 0, PngClaiming(1, 1), "frame.width: 1 must be in"},
      {"PngClaimsMoreRows", kPng, 0, 0, PngClaiming(64, 480), "not a complete PNG"},
  };
}

class BadFrameTest : public ::testing::TestWithParam<BadFrame> {};

TEST_P(BadFrameTest, IsRefusedWithItsReason) {
  const BadFrame& bad = GetParam();
  EXPECT_THAT(DecodeGray({bad.encoding, bad.width, bad.height, bad.data}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(bad.message)));
}

INSTANTIATE_TEST_SUITE_P(All, BadFrameTest, ::testing::ValuesIn(BadFrames()),
                         [](const auto& bad) { return bad.param.name; });

TEST(BadFrameTest, RandomBytesAreRefused) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    std::string bytes(random() % 2000, '\0');
    std::generate(bytes.begin(), bytes.end(), [&random] { return static_cast<char>(random()); });
    EXPECT_FALSE(DecodeGray({kJpeg, 0, 0, bytes}).ok());
    EXPECT_FALSE(DecodeGray({kPng, 0, 0, bytes}).ok());
  }
}

// Whatever happens to a file, the answer is an image of the claimed limits or INVALID_ARGUMENT.
TEST(BadFrameTest, ChangedBytesNeverDoMoreThanFail) {
  std::mt19937 random(5);
  for (const FrameEncoding encoding : {kJpeg, kPng}) {
    const std::string whole = encoding == kJpeg ? Jpeg() : Png();
    for (int trial = 0; trial < 300; ++trial) {
      std::string bytes = whole;
      bytes[random() % bytes.size()] = static_cast<char>(random());
      const auto decoded = DecodeGray({encoding, 0, 0, bytes});
      if (decoded.ok()) {
        EXPECT_LE(decoded->total(), 16U << 20);
      } else {
        EXPECT_EQ(decoded.status().code(), absl::StatusCode::kInvalidArgument);
      }
    }
  }
}

TEST(BadFrameTest, LimitsAreTheCallers) {
  const std::string bytes = Png();
  DecodeLimits limits;
  limits.max_side_px = 63;
  EXPECT_THAT(DecodeGray({kPng, 0, 0, bytes}, limits),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("[16, 63]")));
  limits.max_side_px = 64;
  EXPECT_THAT(DecodeGray({kPng, 0, 0, bytes}, limits), IsOk());
}

class CancelledAt : public Cancellation {
 public:
  explicit CancelledAt(int at) : at_(at) {}
  bool IsCancelled() const override { return ++asked_ >= at_; }

 private:
  const int at_;
  mutable int asked_ = 0;
};

TEST(DecodeGrayTest, NobodyWaitsForTheRestOfAnImage) {
  for (const FrameEncoding encoding : {kJpeg, kPng}) {
    const std::string bytes = encoding == kJpeg ? Jpeg() : Png();
    // Before it, and in the middle of a JPEG, which may have many scans.
    for (const int at : {1, encoding == kJpeg ? 20 : 1}) {
      const CancelledAt cancelled(at);
      DecodeLimits limits;
      limits.cancellation = &cancelled;
      EXPECT_THAT(DecodeGray({encoding, 0, 0, bytes}, limits),
                  StatusIs(absl::StatusCode::kCancelled, HasSubstr("does not wait")));
    }
  }
}

std::string Segment(int marker, const std::string& content) {
  const std::size_t size = content.size() + 2;
  return std::string{'\xff', static_cast<char>(marker), static_cast<char>(size >> 8),
                     static_cast<char>(size & 0xff)} +
         content;
}

// A grey progressive image of `scans` scans, each of a few bytes: one code says that thousands of
// blocks are empty.
std::string JpegOfScans(int width, int height, int scans) {
  const auto two = [](int value) {
    return std::string{static_cast<char>(value >> 8), static_cast<char>(value & 0xff)};
  };
  // Codes of two bits: 00, and 01 for the second.
  const auto codes = [](char table, const std::string& symbols) {
    std::string counts(16, '\0');
    counts[1] = static_cast<char>(symbols.size());
    return Segment(0xc4, table + counts + symbols);
  };
  const auto scan = [](int first, int last) {
    return Segment(0xda, {1, 1, 0, static_cast<char>(first), static_cast<char>(last), 0});
  };
  std::string jpeg = "\xff\xd8" + Segment(0xdb, std::string(1, '\0') + std::string(64, '\1'));
  jpeg += Segment(0xc2, '\x08' + two(height) + two(width) + std::string{1, 1, 0x11, 0});
  jpeg += codes('\x00', std::string(1, '\0')) + codes('\x10', "\xe0");
  const int blocks = (width / 8) * (height / 8);
  jpeg += scan(0, 0) + std::string(static_cast<std::size_t>((blocks + 3) / 4), '\0');
  // Runs of 2^14 blocks, as 00 and 14 bits of 0.
  const std::string empty(static_cast<std::size_t>(2 * ((blocks + 16383) / 16384)), '\0');
  for (int coefficient = 1; coefficient < scans; ++coefficient) {
    jpeg += scan(coefficient, coefficient) + empty;
  }
  return jpeg + "\xff\xd9";
}

TEST(DecodeGrayTest, ALargeImageOfManyScansIsRefusedBeforeItTakesSeconds) {
  const std::string usual = JpegOfScans(4096, 4096, 20);
  EXPECT_THAT(DecodeGray({kJpeg, 0, 0, usual}), IsOk());
  const std::string small = JpegOfScans(256, 64, 64);
  EXPECT_THAT(DecodeGray({kJpeg, 0, 0, small}), IsOk());
  const std::string bomb = JpegOfScans(4096, 4096, 64);
  EXPECT_THAT(DecodeGray({kJpeg, 0, 0, bomb}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("more than 32 scans")));
}

}  // namespace
}  // namespace homing
