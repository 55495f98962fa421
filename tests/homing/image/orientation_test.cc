#include "homing/image/orientation.h"

#include <gtest/gtest.h>

#include "homing/image/frame.h"
#include "homing/image/header_pixels.h"
#include "tests/homing/image/encoded_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

std::string BigEndian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 255U);
  return text;
}

// A TIFF header with another tag before the orientation.
std::string Tiff(int orientation, bool big) {
  const auto number = [big](std::uint32_t value, int bytes) {
    std::string text = BigEndian(value, bytes);
    return big ? text : std::string(text.rbegin(), text.rend());
  };
  const auto entry = [&](std::uint32_t tag, std::uint32_t value) {
    return number(tag, 2) + number(3, 2) + number(1, 4) + number(value, 2) + number(0, 2);
  };
  return (big ? "MM" : "II") + number(42, 2) + number(8, 4) + number(2, 2) + entry(0x0100, 640) +
         entry(0x0112, static_cast<std::uint32_t>(orientation)) + number(0, 4);
}

std::string WithExif(const std::string& jpeg, const std::string& tiff) {
  const std::string body = std::string("Exif\0\0", 6) + tiff;
  return jpeg.substr(0, 2) + "\xFF\xE1" +
         BigEndian(static_cast<std::uint32_t>(body.size() + 2), 2) + body + jpeg.substr(2);
}

// Brighter to the right and, less so, downwards.
cv::Mat Slope() {
  cv::Mat image(32, 48, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<unsigned char>(y, x) = static_cast<unsigned char>(4 * x + y);
    }
  }
  return image;
}

TEST(OrientationTest, IsReadInBothByteOrders) {
  const std::string jpeg = EncodeJpeg(Slope());
  EXPECT_EQ(ExifOrientation(jpeg), 1);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    for (const bool big : {false, true}) {
      EXPECT_EQ(ExifOrientation(WithExif(jpeg, Tiff(orientation, big))), orientation);
    }
  }
  EXPECT_EQ(ExifOrientation(WithExif(jpeg, Tiff(9, true))), 1);
  EXPECT_EQ(ExifOrientation(WithExif(jpeg, "nothing")), 1);
}

TEST(OrientationTest, IsReadInPngAndWebp) {
  const std::string tiff = Tiff(6, true);
  const std::string length = BigEndian(static_cast<std::uint32_t>(tiff.size()), 4);
  const std::string png = EncodePng(Slope(), {});
  EXPECT_EQ(ExifOrientation(png), 1);
  // After the header chunk of 25 bytes; the checksum is not read here.
  EXPECT_EQ(ExifOrientation(png.substr(0, 33) + length + "eXIf" + tiff + "csum" + png.substr(33)),
            6);
  const std::string webp = std::string("RIFF\0\0\0\0WEBP", 12) + "VP8 " +
                           std::string("\1\0\0\0x\0", 6) + "EXIF" +
                           std::string(length.rbegin(), length.rend()) + tiff;
  EXPECT_EQ(ExifOrientation(webp), 6);
}

TEST(OrientationTest, CutFilesAreUpright) {
  const std::string file = WithExif(EncodeJpeg(Slope()), Tiff(6, false));
  for (std::size_t size = 0; size < 60; ++size) {
    const int orientation = ExifOrientation(file.substr(0, size));
    EXPECT_TRUE(orientation == 1 || orientation == 6) << size;
  }
}

// Where the brightest and the darkest corner of Slope are after turning.
TEST(OrientationTest, TurnsUpright) {
  struct Corner {
    bool right = false;
    bool bottom = false;
  };
  const std::array<Corner, 8> darkest = {{{false, false},
                                          {true, false},
                                          {true, true},
                                          {false, true},
                                          {false, false},
                                          {true, false},
                                          {true, true},
                                          {false, true}}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const cv::Mat upright = TurnUpright(Slope(), orientation);
    EXPECT_EQ(upright.cols, orientation < 5 ? 48 : 32);
    const Corner corner = darkest[static_cast<std::size_t>(orientation - 1)];
    const int x = corner.right ? upright.cols - 1 : 0;
    const int y = corner.bottom ? upright.rows - 1 : 0;
    EXPECT_EQ(upright.at<unsigned char>(y, x), 0) << orientation;
    EXPECT_EQ(upright.at<unsigned char>(upright.rows - 1 - y, upright.cols - 1 - x), 219);
  }
}

TEST(OrientationTest, DecodingTurnsTheImage) {
  const std::string file = WithExif(EncodeJpeg(Slope(), 100), Tiff(3, false));
  const auto gray = DecodeGray({FrameEncoding::kJpeg, 48, 32, file});
  ASSERT_THAT(gray, IsOk());
  EXPECT_GT(gray->at<unsigned char>(0, 0), 200);
  EXPECT_LT(gray->at<unsigned char>(31, 47), 20);
}

TEST(OrientationTest, TheSizeOfTheTurnedImageIsInTheHeader) {
  const std::string file = WithExif(EncodeJpeg(Slope(), 100), Tiff(6, false));
  // Without most of the pixels.
  const std::string cut = file.substr(0, file.size() - 200);
  EXPECT_FALSE(DecodeGray({FrameEncoding::kJpeg, 0, 0, cut}).ok());
  EXPECT_EQ(MeasureGray({FrameEncoding::kJpeg, 0, 0, cut}).value(), cv::Size(32, 48));
  const std::string png = EncodePng(Slope(), {}).substr(0, 50);
  EXPECT_FALSE(DecodeGray({FrameEncoding::kPng, 0, 0, png}).ok());
  EXPECT_EQ(MeasureGray({FrameEncoding::kPng, 0, 0, png}).value(), cv::Size(48, 32));
  EXPECT_FALSE(MeasureGray({FrameEncoding::kPng, 49, 0, png}).ok());
}

TEST(OrientationTest, PixelsAreCountedByTheHeader) {
  const std::string jpeg = WithExif(EncodeJpeg(Slope()), Tiff(6, false));
  const std::string png = EncodePng(Slope(), {});
  EXPECT_EQ(HeaderPixels({FrameEncoding::kGray8, 8192, 8192, ""}), 8192 * 8192);
  for (const auto& [encoding, file] :
       {std::pair(FrameEncoding::kJpeg, jpeg), std::pair(FrameEncoding::kPng, png)}) {
    EXPECT_EQ(HeaderPixels({encoding, 0, 0, file}), 48 * 32);
    for (std::size_t size = 0; size < file.size(); ++size) {
      const auto pixels = HeaderPixels({encoding, 0, 0, file.substr(0, size)});
      EXPECT_TRUE(!pixels || *pixels == 48 * 32) << size;
    }
  }
  EXPECT_EQ(HeaderPixels({FrameEncoding::kJpeg, 0, 0, "\xFF\xD8nothing"}), std::nullopt);
}

}  // namespace
}  // namespace homing
