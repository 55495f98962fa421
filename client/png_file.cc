#include "client/png_file.h"

#include <spng.h>

#include <cerrno>
#include <cstdio>
#include <memory>

#include "absl/strings/str_cat.h"
#include "client/file/output_file.h"

namespace homing::client {

absl::Status WritePng(const std::string& path, const SourceFrame& gray) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                             &std::fclose);
  if (file == nullptr) return CannotWrite(path, errno);
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(SPNG_CTX_ENCODER),
                                                               &spng_ctx_free);
  spng_ihdr header{};
  header.width = static_cast<std::uint32_t>(gray.width);
  header.height = static_cast<std::uint32_t>(gray.height);
  header.bit_depth = 8;
  header.color_type = SPNG_COLOR_TYPE_GRAYSCALE;
  int error = spng_set_png_file(context.get(), file.get());
  if (error == 0) error = spng_set_ihdr(context.get(), &header);
  if (error == 0) {
    error = spng_encode_image(context.get(), gray.data.data(), gray.data.size(), SPNG_FMT_PNG,
                              SPNG_ENCODE_FINALIZE);
  }
  if (error != 0) return absl::InternalError(absl::StrCat(path, ": ", spng_strerror(error)));
  if (std::fflush(file.get()) != 0) return CannotWrite(path, errno);
  return absl::OkStatus();
}

}  // namespace homing::client
