#include "client/bag/raw_image.h"

#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

using ::testing::HasSubstr;

RawImage Image(const char* encoding, std::uint32_t step, const std::string& data) {
  return {2, 2, step, encoding, false, data};
}

std::string Bytes(const RawImage& image) {
  const auto frame = ConvertRawImage(image);
  return frame.ok() ? frame->data : std::string(frame.status().message());
}

TEST(RawImageTest, GreyKeepsItsPixels) {
  const auto frame = ConvertRawImage(Image("mono8", 3, "ab-cd-"));
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(frame->encoding, FrameEncoding::kGray8);
  EXPECT_EQ(frame->width, 2);
  EXPECT_EQ(frame->data, "abcd");
  // The last row may lack its padding.
  EXPECT_EQ(Bytes(Image("8UC1", 3, "ab-cd")), "abcd");
}

TEST(RawImageTest, ColourKeepsItsOrder) {
  const auto rgb = ConvertRawImage(Image("rgb8", 6, "rgbRGBrgbRGB"));
  ASSERT_THAT(rgb, IsOk());
  EXPECT_EQ(rgb->encoding, FrameEncoding::kRgb8);
  EXPECT_EQ(rgb->data, "rgbRGBrgbRGB");
  const auto bgr = ConvertRawImage(Image("bgr8", 7, "bgrBGR-bgrBGR-"));
  ASSERT_THAT(bgr, IsOk());
  EXPECT_EQ(bgr->encoding, FrameEncoding::kBgr8);
  EXPECT_EQ(bgr->data, "bgrBGRbgrBGR");
}

TEST(RawImageTest, AlphaIsDropped) {
  const auto rgba = ConvertRawImage(Image("rgba8", 8, "rgbaRGBArgbaRGBA"));
  ASSERT_THAT(rgba, IsOk());
  EXPECT_EQ(rgba->encoding, FrameEncoding::kRgb8);
  EXPECT_EQ(rgba->data, "rgbRGBrgbRGB");
  EXPECT_EQ(Bytes(Image("bgra8", 8, "bgraBGRAbgraBGRA")), "bgrBGRbgrBGR");
}

TEST(RawImageTest, OfYuvTheLuminanceIsTaken) {
  EXPECT_EQ(Bytes(Image("yuv422", 4, "u1v2u3v4")), "1234");
  EXPECT_EQ(Bytes(Image("uyvy", 4, "u1v2u3v4")), "1234");
  EXPECT_EQ(Bytes(Image("yuv422_yuy2", 4, "1u2v3u4v")), "1234");
  EXPECT_EQ(Bytes(Image("nv12", 2, "1234uv")), "1234");
}

TEST(RawImageTest, SixteenBitsAreStretched) {
  // 7000, 8020, 9040, 7000.
  const std::string little("\x58\x1b\x54\x1f\x50\x23\x58\x1b", 8);
  EXPECT_EQ(Bytes(Image("mono16", 4, little)), std::string("\x00\x80\xff\x00", 4));
  const std::string big("\x1b\x58\x1f\x54\x23\x50\x1b\x58", 8);
  RawImage image = Image("16UC1", 4, big);
  image.big_endian = true;
  EXPECT_EQ(Bytes(image), std::string("\x00\x80\xff\x00", 4));
  EXPECT_EQ(Bytes(Image("mono16", 4, std::string(8, '\5'))), std::string(4, '\x80'));
}

// One dead pixel must not leave a few grey levels to the others, as in a PNG file.
TEST(RawImageTest, ADeadPixelDoesNotSetTheRangeOfSixteenBits) {
  constexpr std::uint32_t kSide = 64;
  std::string pixels;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const std::uint32_t value = i == 100 ? 65535 : 7000 + i % 256;
    pixels.push_back(static_cast<char>(value & 255));
    pixels.push_back(static_cast<char>(value >> 8));
  }
  const auto frame = ConvertRawImage({kSide, kSide, 2 * kSide, "mono16", false, pixels});
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(static_cast<unsigned char>(frame->data[0]), 0);
  EXPECT_EQ(static_cast<unsigned char>(frame->data[128]), 128);
  EXPECT_EQ(static_cast<unsigned char>(frame->data[255]), 255);
}

// A Bayer image of one colour: red pixels 200, green 100, blue 50.
std::string Bayer(const std::string& pattern) {
  std::string pixels;
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 8; ++x) {
      const char colour = pattern[2 * (y % 2) + x % 2];
      pixels.push_back(static_cast<char>(colour == 'r' ? 200 : colour == 'g' ? 100 : 50));
    }
  }
  return pixels;
}

TEST(RawImageTest, BayerPatternsBecomeTheirGrey) {
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    const std::string encoding = "bayer_" + pattern + "8";
    const std::string pixels = Bayer(pattern);
    const auto frame = ConvertRawImage({8, 8, 8, encoding, false, pixels});
    ASSERT_THAT(frame, IsOk());
    // 0.299 R + 0.587 G + 0.114 B = 124.2.
    for (const char pixel : frame->data) {
      EXPECT_NEAR(static_cast<unsigned char>(pixel), 124, 1) << pattern;
    }
  }
}

TEST(RawImageTest, RefusesWhatItCannotRead) {
  EXPECT_THAT(ConvertRawImage(Image("32FC1", 8, std::string(16, 'a'))),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("32FC1")));
  EXPECT_THAT(ConvertRawImage(Image("mono8", 2, "abc")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("3 bytes")));
  EXPECT_THAT(ConvertRawImage(Image("rgb8", 5, std::string(100, 'a'))),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("rows of 5")));
  EXPECT_THAT(ConvertRawImage({0, 2, 2, "mono8", false, "abcd"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("0 x 2")));
  EXPECT_THAT(ConvertRawImage({0xffffffff, 0xffffffff, 0xffffffff, "mono8", false, "abcd"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("8192")));
}

}  // namespace
}  // namespace homing::client::bag
