#include "client/picture/canvas.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "homing/image/frame.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

std::string TemporaryPath(const std::string& name) {
  return (std::filesystem::temp_directory_path() /
          ("homing_canvas_" + std::to_string(::getpid()) + "_" + name))
      .string();
}

std::string ReadAndRemove(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  std::filesystem::remove(path);
  return bytes.str();
}

cv::Mat DecodePng(const std::string& bytes) {
  const auto gray = DecodeGray({FrameEncoding::kPng, 0, 0, bytes});
  EXPECT_THAT(gray, IsOk());
  return gray.ok() ? *gray : cv::Mat();
}

TEST(CanvasTest, WritesPngAtTwoPixelsAPoint) {
  const std::string path = TemporaryPath("a.png");
  auto canvas = Canvas::Create(path, 100, 50);
  ASSERT_THAT(canvas, IsOk());
  canvas->Fill({0, 0, 50, 50}, {0, 0, 0, 1});
  ASSERT_THAT(canvas->Finish(), IsOk());
  const cv::Mat image = DecodePng(ReadAndRemove(path));
  ASSERT_EQ(image.cols, 200);
  ASSERT_EQ(image.rows, 100);
  EXPECT_EQ(image.at<unsigned char>(50, 20), 0);
  EXPECT_EQ(image.at<unsigned char>(50, 180), 255);
}

TEST(CanvasTest, WritesSvgWithItsText) {
  const std::string path = TemporaryPath("a.svg");
  auto canvas = Canvas::Create(path, 100, 50);
  ASSERT_THAT(canvas, IsOk());
  canvas->Text({10, 10}, "P_T");
  ASSERT_THAT(canvas->Finish(), IsOk());
  const std::string svg = ReadAndRemove(path);
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
}

TEST(CanvasTest, ImagesAreMixedWithWhite) {
  const std::string path = TemporaryPath("b.png");
  auto canvas = Canvas::Create(path, 10, 10);
  ASSERT_THAT(canvas, IsOk());
  canvas->Image({0, 0, 10, 10}, {1, 1, std::string(1, '\0')}, 0.4);
  ASSERT_THAT(canvas->Finish(), IsOk());
  EXPECT_NEAR(DecodePng(ReadAndRemove(path)).at<unsigned char>(10, 10), 255 * 0.6, 1);
}

TEST(CanvasTest, RefusesOtherEndings) {
  EXPECT_THAT(Canvas::Create("a.jpg", 10, 10),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(".svg or .png")));
}

TEST(CanvasTest, SaysWhereItCannotWrite) {
  for (const char* path : {"/does/not/exist/a.png", "/does/not/exist/a.svg"}) {
    auto canvas = Canvas::Create(path, 10, 10);
    const absl::Status status = canvas.ok() ? canvas->Finish() : canvas.status();
    EXPECT_THAT(status, StatusIs(absl::StatusCode::kNotFound, HasSubstr(path)));
  }
}

}  // namespace
}  // namespace homing::client
