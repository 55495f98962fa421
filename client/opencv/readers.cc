// The entry of the module that client/source/opencv_readers.h loads.
#include "client/source/opencv_readers.h"

#include <opencv2/imgcodecs.hpp>

#include "absl/strings/str_cat.h"
#include "client/opencv/video_source.h"
#include "homing/image/deep_gray.h"

namespace homing::client {
namespace {

absl::StatusOr<SourceFrame> ReadGrayImage(const std::string& path) {
  cv::Mat image;
  try {
    image = cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.depth() != CV_8U && !image.empty()) {
    if (image.depth() != CV_16U) image.convertTo(image, CV_32F);
    image = StretchToGray8(image);
  }
  if (image.empty()) return absl::InvalidArgumentError(absl::StrCat(path, " is not an image"));
  return SourceFrame{FrameEncoding::kGray8, image.cols, image.rows,
                     std::string(reinterpret_cast<const char*>(image.data), image.total())};
}

constexpr OpenCvReaders kReaders = {.read_gray_image = &ReadGrayImage, .open_video = &OpenVideo};

}  // namespace
}  // namespace homing::client

extern "C" __attribute__((visibility("default"))) const homing::client::OpenCvReaders*
HomingOpenCvReaders() {
  return &homing::client::kReaders;
}
