#include "client/bag/raw_image.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/image/deep_gray.h"

namespace homing::client::bag {
namespace {

constexpr std::uint32_t kMinSidePx = 2;
constexpr std::uint32_t kMaxSidePx = 8192;

enum class Layout { kGray8, kGray16, kRgb, kBgr, kBayer };

struct Encoding {
  const char* name;
  Layout layout;
  // Bytes of a pixel, and those before the first byte that is used.
  std::uint32_t pixel_bytes;
  std::uint32_t skip = 0;
  int bayer_code = 0;
};

// OpenCV names a Bayer pattern by its second row's second and third pixel.
constexpr std::array<Encoding, 20> kEncodings = {{
    {"mono8", Layout::kGray8, 1},
    {"8UC1", Layout::kGray8, 1},
    {"mono16", Layout::kGray16, 2},
    {"16UC1", Layout::kGray16, 2},
    {"rgb8", Layout::kRgb, 3},
    {"bgr8", Layout::kBgr, 3},
    {"8UC3", Layout::kBgr, 3},
    {"rgba8", Layout::kRgb, 4},
    {"bgra8", Layout::kBgr, 4},
    {"8UC4", Layout::kBgr, 4},
    {"bayer_rggb8", Layout::kBayer, 1, 0, cv::COLOR_BayerBG2GRAY},
    {"bayer_bggr8", Layout::kBayer, 1, 0, cv::COLOR_BayerRG2GRAY},
    {"bayer_gbrg8", Layout::kBayer, 1, 0, cv::COLOR_BayerGR2GRAY},
    {"bayer_grbg8", Layout::kBayer, 1, 0, cv::COLOR_BayerGB2GRAY},
    {"yuv422", Layout::kGray8, 2, 1},
    {"uyvy", Layout::kGray8, 2, 1},
    {"yuv422_yuy2", Layout::kGray8, 2},
    {"yuyv", Layout::kGray8, 2},
    // The Y plane comes first.
    {"nv12", Layout::kGray8, 1},
    {"nv21", Layout::kGray8, 1},
}};

absl::StatusOr<Encoding> FindEncoding(std::string_view name) {
  const auto found = std::find_if(kEncodings.begin(), kEncodings.end(),
                                  [&](const Encoding& known) { return name == known.name; });
  if (found != kEncodings.end()) return *found;
  std::string names;
  for (const Encoding& known : kEncodings) {
    absl::StrAppend(&names, names.empty() ? "" : ", ", known.name);
  }
  return absl::InvalidArgumentError(
      absl::StrCat("the image's encoding \"", std::string(name), "\" is not one of ", names));
}

absl::Status CheckSize(const RawImage& image, const Encoding& encoding) {
  const auto good = [](std::uint32_t side) { return side >= kMinSidePx && side <= kMaxSidePx; };
  if (!good(image.width) || !good(image.height)) {
    return absl::InvalidArgumentError(absl::StrCat("the image has ", image.width, " x ",
                                                   image.height, " pixels, a side must be in [",
                                                   kMinSidePx, ", ", kMaxSidePx, "]"));
  }
  const std::uint64_t needed =
      std::uint64_t{image.step} * (image.height - 1) + image.width * encoding.pixel_bytes;
  if (image.step < image.width * encoding.pixel_bytes || image.data.size() < needed) {
    return absl::InvalidArgumentError(
        absl::StrCat("the image has ", image.data.size(), " bytes in rows of ", image.step, "; ",
                     image.width, " x ", image.height, " pixels of ", encoding.name, " need more"));
  }
  return absl::OkStatus();
}

// `kept` bytes of each pixel, without gaps.
std::string Pack(const RawImage& image, const Encoding& encoding, std::size_t kept) {
  std::string packed;
  packed.reserve(std::size_t{image.width} * image.height * kept);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    const std::string_view row = image.data.substr(std::size_t{image.step} * y);
    if (kept == encoding.pixel_bytes) {
      packed.append(row.substr(0, image.width * kept));
      continue;
    }
    for (std::uint32_t x = 0; x < image.width; ++x) {
      packed.append(row.substr(x * encoding.pixel_bytes + encoding.skip, kept));
    }
  }
  return packed;
}

std::string GrayOf16Bit(std::string packed, const RawImage& image) {
  // The machine counts as little endian, as in ByteReader.
  for (std::size_t i = 0; image.big_endian && i < packed.size(); i += 2) {
    std::swap(packed[i], packed[i + 1]);
  }
  const cv::Mat deep(static_cast<int>(image.height), static_cast<int>(image.width), CV_16UC1,
                     packed.data());
  const cv::Mat gray = StretchToGray8(deep);
  return {reinterpret_cast<const char*>(gray.data), gray.total()};
}

absl::StatusOr<std::string> GrayOfBayer(std::string packed, const RawImage& image, int code) {
  const auto width = static_cast<int>(image.width);
  const auto height = static_cast<int>(image.height);
  std::string gray(packed.size(), '\0');
  try {
    const cv::Mat pattern(height, width, CV_8UC1, packed.data());
    cv::Mat result(height, width, CV_8UC1, gray.data());
    cv::cvtColor(pattern, result, code);
  } catch (const cv::Exception& error) {
    return absl::InvalidArgumentError(absl::StrCat("the Bayer image: ", error.err));
  }
  return gray;
}

}  // namespace

absl::StatusOr<SourceFrame> ConvertRawImage(const RawImage& image) {
  HOMING_ASSIGN_OR_RETURN(const Encoding encoding, FindEncoding(image.encoding));
  HOMING_RETURN_IF_ERROR(CheckSize(image, encoding));
  SourceFrame frame;
  frame.width = static_cast<int>(image.width);
  frame.height = static_cast<int>(image.height);
  switch (encoding.layout) {
    case Layout::kGray8:
      frame.data = Pack(image, encoding, 1);
      break;
    case Layout::kGray16:
      frame.data = GrayOf16Bit(Pack(image, encoding, 2), image);
      break;
    case Layout::kRgb:
    case Layout::kBgr:
      frame.encoding =
          encoding.layout == Layout::kRgb ? FrameEncoding::kRgb8 : FrameEncoding::kBgr8;
      frame.data = Pack(image, encoding, 3);
      break;
    case Layout::kBayer: {
      HOMING_ASSIGN_OR_RETURN(frame.data,
                              GrayOfBayer(Pack(image, encoding, 1), image, encoding.bayer_code));
      break;
    }
  }
  return frame;
}

}  // namespace homing::client::bag
