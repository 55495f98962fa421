#include "homing/image/jpeg_decoder.h"

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <string>

// jpeglib.h needs <cstdio> before it.
#include <jerror.h>
#include <jpeglib.h>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/image/dimensions.h"

namespace homing {
namespace {

// Most scans of a progressive file; cameras write about ten. Each scan visits all pixels, so a file
// with more scans is an attack on processing time. For large files the limit on work is lower.
constexpr int kMaxScans = 500;
constexpr std::int64_t kMaxPixelsOfScans = std::int64_t{1} << 29;

// libjpeg's state of one image. `jump` is where its errors end; no object with a destructor may
// live between setjmp and a call into libjpeg.
struct Decoder {
  Decoder() = default;
  ~Decoder() { jpeg_destroy_decompress(&jpeg); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  const Cancellation* cancellation = nullptr;
  int max_scans = kMaxScans;
  char message[JMSG_LENGTH_MAX] = "";
};

[[noreturn]] void Fail(j_common_ptr jpeg) {
  auto* decoder = static_cast<Decoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, decoder->message);
  std::longjmp(decoder->jump, 1);
}

// A warning means invented pixels (a file that ends early): as bad as an error. Bytes
// between the pixels and the next marker are harmless: many cameras write them.
void Warn(j_common_ptr jpeg, int level) {
  if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) Fail(jpeg);
}

// Called for each row of blocks of each scan.
void LimitWork(j_common_ptr jpeg) {
  auto* decoder = static_cast<Decoder*>(jpeg->client_data);
  if (decoder->cancellation != nullptr && decoder->cancellation->IsCancelled()) {
    std::longjmp(decoder->jump, 1);
  }
  if (decoder->jpeg.input_scan_number <= decoder->max_scans) return;
  std::snprintf(decoder->message, sizeof(decoder->message), "it has more than %d scans",
                decoder->max_scans);
  std::longjmp(decoder->jump, 1);
}

void Begin(Decoder* decoder) {
  decoder->jpeg.err = jpeg_std_error(&decoder->errors);
  decoder->errors.error_exit = &Fail;
  decoder->errors.emit_message = &Warn;
  decoder->jpeg.client_data = decoder;
}

// False: `message` says why.
bool ReadHeader(Decoder* decoder, std::string_view bytes) {
  if (setjmp(decoder->jump) != 0) return false;
  jpeg_create_decompress(&decoder->jpeg);
  decoder->progress.progress_monitor = &LimitWork;
  decoder->jpeg.progress = &decoder->progress;
  jpeg_mem_src(&decoder->jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&decoder->jpeg, TRUE);
  return true;
}

// `pixels`: rows of `step` bytes.
bool ReadPixels(Decoder* decoder, unsigned char* pixels, std::size_t step) {
  if (setjmp(decoder->jump) != 0) return false;
  decoder->jpeg.out_color_space = JCS_GRAYSCALE;
  decoder->jpeg.dct_method = JDCT_ISLOW;
  jpeg_start_decompress(&decoder->jpeg);
  while (decoder->jpeg.output_scanline < decoder->jpeg.output_height) {
    JSAMPROW row = pixels + decoder->jpeg.output_scanline * step;
    jpeg_read_scanlines(&decoder->jpeg, &row, 1);
  }
  jpeg_finish_decompress(&decoder->jpeg);
  return true;
}

absl::Status JpegError(const Decoder& decoder) {
  return FieldError("frame.data", absl::StrCat("is not a complete JPEG image: ", decoder.message));
}

// The size in the header, within the limits.
absl::StatusOr<cv::Size> ReadSize(const Frame& frame, const DecodeLimits& limits,
                                  Decoder* decoder) {
  decoder->cancellation = limits.cancellation;
  Begin(decoder);
  if (!ReadHeader(decoder, frame.data)) return JpegError(*decoder);
  const Dimensions size{decoder->jpeg.image_width, decoder->jpeg.image_height};
  HOMING_RETURN_IF_ERROR(CheckLimits(size, limits));
  HOMING_RETURN_IF_ERROR(CheckDeclared(frame, size));
  return cv::Size(static_cast<int>(size.width), static_cast<int>(size.height));
}

}  // namespace

absl::StatusOr<cv::Size> MeasureJpeg(const Frame& frame, const DecodeLimits& limits) {
  Decoder decoder;
  return ReadSize(frame, limits, &decoder);
}

absl::StatusOr<cv::Mat> DecodeJpeg(const Frame& frame, const DecodeLimits& limits) {
  Decoder decoder;
  HOMING_ASSIGN_OR_RETURN(const cv::Size size, ReadSize(frame, limits, &decoder));
  const std::int64_t pixels = std::int64_t{size.width} * std::int64_t{size.height};
  decoder.max_scans =
      static_cast<int>(std::min<std::int64_t>(kMaxScans, kMaxPixelsOfScans / pixels));
  cv::Mat gray(size, CV_8UC1);
  if (!ReadPixels(&decoder, gray.data, gray.step[0])) {
    HOMING_RETURN_IF_ERROR(CheckAwaited(limits.cancellation));
    return JpegError(decoder);
  }
  return gray;
}

}  // namespace homing
