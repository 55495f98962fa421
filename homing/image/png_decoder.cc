#include "homing/image/png_decoder.h"

#include <spng.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/image/deep_gray.h"
#include "homing/image/dimensions.h"

namespace homing {
namespace {

// Limit on the inflated size of all ancillary chunks (text, profiles), bytes.
constexpr std::size_t kChunkBytes = 1 << 20;

struct ContextCloser {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, ContextCloser>;

absl::Status PngError(int code) {
  return FieldError("frame.data",
                    absl::StrCat("is not a complete PNG image: ", spng_strerror(code)));
}

// Decodes to `format`, 8 bits a channel, as `type`; then reads the rest of the file.
absl::StatusOr<cv::Mat> DecodePixels(spng_ctx* context, const spng_ihdr& header, spng_format format,
                                     int type) {
  cv::Mat pixels(static_cast<int>(header.height), static_cast<int>(header.width), type);
  const std::size_t length = pixels.total() * pixels.elemSize();
  if (const int code = spng_decode_image(context, pixels.data, length, format, 0); code != 0) {
    return PngError(code);
  }
  if (const int code = spng_decode_chunks(context); code != 0) {
    return PngError(code);
  }
  return pixels;
}

// The header, of an image within the limits.
absl::StatusOr<spng_ihdr> ReadHeader(spng_ctx* context, const Frame& frame,
                                     const DecodeLimits& limits) {
  if (context == nullptr) {
    return absl::InternalError("no PNG decoder could be made");
  }
  spng_set_chunk_limits(context, kChunkBytes, kChunkBytes);
  spng_ihdr header{};
  int code = spng_set_png_buffer(context, frame.data.data(), frame.data.size());
  if (code == 0) {
    code = spng_get_ihdr(context, &header);
  }
  if (code != 0) {
    return PngError(code);
  }
  const Dimensions dimensions{header.width, header.height};
  HOMING_RETURN_IF_ERROR(CheckLimits(dimensions, limits));
  HOMING_RETURN_IF_ERROR(CheckDeclared(frame, dimensions));
  return header;
}

}  // namespace

absl::StatusOr<cv::Size> MeasurePng(const Frame& frame, const DecodeLimits& limits) {
  const Context context(spng_ctx_new(0));
  HOMING_ASSIGN_OR_RETURN(const spng_ihdr header, ReadHeader(context.get(), frame, limits));
  return cv::Size(static_cast<int>(header.width), static_cast<int>(header.height));
}

absl::StatusOr<cv::Mat> DecodePng(const Frame& frame, const DecodeLimits& limits) {
  const Context context(spng_ctx_new(0));
  HOMING_ASSIGN_OR_RETURN(const spng_ihdr header, ReadHeader(context.get(), frame, limits));
  if (header.bit_depth == 16 && header.color_type == SPNG_COLOR_TYPE_GRAYSCALE) {
    HOMING_ASSIGN_OR_RETURN(const cv::Mat deep,
                            DecodePixels(context.get(), header, SPNG_FMT_PNG, CV_16UC1));
    return StretchToGray8(deep);
  }
  if (header.bit_depth == 16 && header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA) {
    HOMING_ASSIGN_OR_RETURN(const cv::Mat with_alpha,
                            DecodePixels(context.get(), header, SPNG_FMT_PNG, CV_16UC2));
    cv::Mat deep;
    cv::extractChannel(with_alpha, deep, 0);
    return StretchToGray8(deep);
  }
  // Colour, palette and alpha all become RGB8 first; alpha is dropped.
  if (header.color_type == SPNG_COLOR_TYPE_GRAYSCALE && header.bit_depth <= 8) {
    return DecodePixels(context.get(), header, SPNG_FMT_G8, CV_8UC1);
  }
  HOMING_ASSIGN_OR_RETURN(const cv::Mat color,
                          DecodePixels(context.get(), header, SPNG_FMT_RGB8, CV_8UC3));
  cv::Mat gray;
  cv::cvtColor(color, gray, cv::COLOR_RGB2GRAY);
  return gray;
}

}  // namespace homing
