#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "homing/image/frame.h"
#include "tests/homing/image/encoded_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// Busy enough that a large image needs many bytes.
cv::Mat ColorPicture(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b(cv::saturate_cast<unsigned char>(128 + 90 * std::sin(0.11 * x)),
                    cv::saturate_cast<unsigned char>(128 + 90 * std::cos(0.07 * y + 0.05 * x)),
                    static_cast<unsigned char>((x + 2 * y) % 256));
    }
  }
  return image;
}

cv::Mat GrayPicture(int width, int height) {
  cv::Mat gray;
  cv::cvtColor(ColorPicture(width, height), gray, cv::COLOR_RGB2GRAY);
  return gray;
}

Frame Raw(FrameEncoding encoding, const cv::Mat& image) {
  return {encoding,
          image.cols,
          image.rows,
          {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()}};
}

double MaxDifference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(DecodeGrayTest, Gray8IsCopied) {
  cv::Mat image = GrayPicture(40, 30);
  const cv::Mat before = image.clone();
  const cv::Mat decoded = DecodeGray(Raw(FrameEncoding::kGray8, image)).value();
  image.setTo(0);
  EXPECT_EQ(MaxDifference(decoded, before), 0);
}

TEST(DecodeGrayTest, ColorIsWeighed) {
  // 0.299 * 200 + 0.587 * 100 + 0.114 * 50 = 124.2.
  const cv::Mat rgb(16, 16, CV_8UC3, cv::Scalar(200, 100, 50));
  const cv::Mat bgr(16, 16, CV_8UC3, cv::Scalar(50, 100, 200));
  EXPECT_EQ(DecodeGray(Raw(FrameEncoding::kRgb8, rgb)).value().at<unsigned char>(3, 5), 124);
  EXPECT_EQ(DecodeGray(Raw(FrameEncoding::kBgr8, bgr)).value().at<unsigned char>(3, 5), 124);
}

TEST(DecodeGrayTest, JpegGivesTheImageBack) {
  for (const cv::Mat& image : {GrayPicture(123, 45), GrayPicture(640, 480)}) {
    const std::string bytes = EncodeJpeg(image, 100);
    const cv::Mat decoded = DecodeGray({FrameEncoding::kJpeg, 0, 0, bytes}).value();
    ASSERT_EQ(decoded.size(), image.size());
    EXPECT_LE(cv::norm(decoded, image, cv::NORM_L1) / static_cast<double>(image.total()), 1);
  }
}

TEST(DecodeGrayTest, ColorJpegIsAsItsGreyWithinRounding) {
  const cv::Mat color = ColorPicture(96, 64);
  const std::string bytes = EncodeJpeg(color, 100);
  const cv::Mat decoded = DecodeGray({FrameEncoding::kJpeg, 96, 64, bytes}).value();
  EXPECT_LE(MaxDifference(decoded, GrayPicture(96, 64)), 4);
  EXPECT_EQ(MaxDifference(decoded, DecodeGray({FrameEncoding::kJpeg, 0, 0, bytes}).value()), 0);
}

TEST(DecodeGrayTest, PngGivesTheImageBackExactly) {
  const cv::Mat gray = GrayPicture(70, 50);
  const cv::Mat color = ColorPicture(70, 50);
  const std::string gray_png = EncodePng(gray, {SPNG_COLOR_TYPE_GRAYSCALE, 8});
  const std::string color_png = EncodePng(color, {SPNG_COLOR_TYPE_TRUECOLOR, 8});
  EXPECT_EQ(MaxDifference(DecodeGray({FrameEncoding::kPng, 70, 50, gray_png}).value(), gray), 0);
  EXPECT_EQ(MaxDifference(DecodeGray({FrameEncoding::kPng, 0, 0, color_png}).value(), gray), 0);
}

TEST(DecodeGrayTest, LargePngInOneOrManyChunksIsDecoded) {
  cv::Mat noise(1500, 2000, CV_8UC1);
  cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
  const std::string bytes = EncodePng(noise, {SPNG_COLOR_TYPE_GRAYSCALE, 8});
  ASSERT_GT(bytes.size(), 2U << 20);
  EXPECT_EQ(MaxDifference(DecodeGray({FrameEncoding::kPng, 0, 0, bytes}).value(), noise), 0);
}

// As a thermal camera writes it: few of the 65536 values, one dead pixel.
cv::Mat Thermal() {
  cv::Mat deep(40, 50, CV_16UC1);
  for (int y = 0; y < deep.rows; ++y) {
    for (int x = 0; x < deep.cols; ++x) {
      deep.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(7000 + 51 * y);
    }
  }
  deep.at<std::uint16_t>(20, 20) = 65535;
  return deep;
}

TEST(DecodeGrayTest, DeepPngIsStretchedToTheRangeItUses) {
  const cv::Mat deep = Thermal();
  cv::Mat with_alpha(deep.size(), CV_16UC2, cv::Scalar(0, 9));
  cv::insertChannel(deep, with_alpha, 0);
  for (const std::string& bytes : {EncodePng(deep, {SPNG_COLOR_TYPE_GRAYSCALE, 16}),
                                   EncodePng(with_alpha, {SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, 16})}) {
    const cv::Mat gray = DecodeGray({FrameEncoding::kPng, 0, 0, bytes}).value();
    EXPECT_EQ(gray.at<unsigned char>(0, 0), 0);
    EXPECT_NEAR(gray.at<unsigned char>(20, 5), 131, 1);
    EXPECT_EQ(gray.at<unsigned char>(39, 49), 255);
  }
}

TEST(DecodeGrayTest, DeepPngOfOneValueIsGrey) {
  const cv::Mat deep(20, 20, CV_16UC1, cv::Scalar(0x8040));
  const std::string bytes = EncodePng(deep, {SPNG_COLOR_TYPE_GRAYSCALE, 16});
  EXPECT_EQ(DecodeGray({FrameEncoding::kPng, 0, 0, bytes}).value().at<unsigned char>(9, 9), 128);
}

TEST(DecodeGrayTest, JpegWithStrayBytesBeforeAMarkerIsTaken) {
  cv::Mat image(48, 64, CV_8UC1);
  cv::RNG(5).fill(image, cv::RNG::UNIFORM, 0, 256);
  const std::string whole = EncodeJpeg(image);
  const std::string end("\xFF\xD9", 2);
  ASSERT_EQ(whole.substr(whole.size() - 2), end);
  const cv::Mat expected = DecodeGray({FrameEncoding::kJpeg, 0, 0, whole}).value();
  for (const std::string& bytes :
       {whole.substr(0, whole.size() - 2) + std::string("\0\0\0", 3) + end,
        whole + std::string(100, '\0'), whole + "text behind the image"}) {
    const auto gray = DecodeGray({FrameEncoding::kJpeg, 0, 0, bytes});
    ASSERT_THAT(gray, IsOk());
    EXPECT_EQ(MaxDifference(*gray, expected), 0);
  }
}

TEST(DecodeGrayTest, AlphaIsDropped) {
  const cv::Mat rgba(20, 20, CV_8UC4, cv::Scalar(200, 100, 50, 3));
  const cv::Mat gray_alpha(20, 20, CV_8UC2, cv::Scalar(77, 3));
  const std::string color = EncodePng(rgba, {SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 8});
  const std::string gray = EncodePng(gray_alpha, {SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, 8});
  EXPECT_EQ(DecodeGray({FrameEncoding::kPng, 0, 0, color}).value().at<unsigned char>(0, 0), 124);
  EXPECT_EQ(DecodeGray({FrameEncoding::kPng, 0, 0, gray}).value().at<unsigned char>(0, 0), 77);
}

TEST(DecodeGrayTest, PaletteIsLookedUp) {
  spng_plte palette{};
  palette.n_entries = 2;
  palette.entries[1] = {200, 100, 50, 255};
  const cv::Mat index(20, 20, CV_8UC1, cv::Scalar(1));
  const std::string bytes = EncodePng(index, {SPNG_COLOR_TYPE_INDEXED, 8}, &palette);
  EXPECT_EQ(DecodeGray({FrameEncoding::kPng, 0, 0, bytes}).value().at<unsigned char>(0, 0), 124);
}

}  // namespace
}  // namespace homing
