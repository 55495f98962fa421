// JPEG and PNG files made in memory.
#ifndef TESTS_HOMING_IMAGE_ENCODED_PICTURES_H_
#define TESTS_HOMING_IMAGE_ENCODED_PICTURES_H_

#include <spng.h>
#include <turbojpeg.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <string>

namespace homing {

// `image` is CV_8UC1 or CV_8UC3 (RGB).
inline std::string EncodeJpeg(const cv::Mat& image, int quality = 95) {
  const tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  const bool gray = image.channels() == 1;
  tjCompress2(handle, image.data, image.cols, static_cast<int>(image.step[0]), image.rows,
              gray ? TJPF_GRAY : TJPF_RGB, &bytes, &length, gray ? TJSAMP_GRAY : TJSAMP_444,
              quality, TJFLAG_ACCURATEDCT);
  std::string result(reinterpret_cast<const char*>(bytes), length);
  tjFree(bytes);
  tjDestroy(handle);
  return result;
}

struct PngKind {
  spng_color_type color_type = SPNG_COLOR_TYPE_GRAYSCALE;
  unsigned char bit_depth = 8;
};

// `image` holds the bytes as `kind` says, host order, `palette` where it has one.
inline std::string EncodePng(const cv::Mat& image, const PngKind& kind,
                             const spng_plte* palette = nullptr) {
  spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
  spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = static_cast<unsigned>(image.cols);
  header.height = static_cast<unsigned>(image.rows);
  header.color_type = static_cast<unsigned char>(kind.color_type);
  header.bit_depth = kind.bit_depth;
  spng_set_ihdr(context, &header);
  if (palette != nullptr) {
    spng_plte copy = *palette;
    spng_set_plte(context, &copy);
  }
  spng_encode_image(context, image.data, image.total() * image.elemSize(), SPNG_FMT_PNG,
                    SPNG_ENCODE_FINALIZE);
  std::size_t length = 0;
  int error = 0;
  void* bytes = spng_get_png_buffer(context, &length, &error);
  std::string result(static_cast<const char*>(bytes), length);
  std::free(bytes);
  spng_ctx_free(context);
  return result;
}

}  // namespace homing

#endif  // TESTS_HOMING_IMAGE_ENCODED_PICTURES_H_
