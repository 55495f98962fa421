#include "client/bag/decompression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

// The output grows by at most this much at once: a size that the file claims is never allocated
// without data.
constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;

// One step: consumes input, fills [out, out + room). DATA_LOSS.
struct Progress {
  std::size_t consumed = 0;
  std::size_t produced = 0;
  bool end = false;
};

// Calls step(input, output, room) until the end of the stream.
template <typename Step>
absl::StatusOr<std::string> Run(std::string_view bytes, std::uint64_t most, const Step& step) {
  std::string result;
  while (true) {
    const std::size_t before = result.size();
    // Leaves room for one byte more than allowed, so that a longer output is detected.
    const std::uint64_t room = std::min(kPiece, most + 1 - before);
    result.resize(before + static_cast<std::size_t>(room));
    HOMING_ASSIGN_OR_RETURN(const Progress progress,
                            step(bytes, result.data() + before, static_cast<std::size_t>(room)));
    bytes.remove_prefix(progress.consumed);
    result.resize(before + progress.produced);
    if (result.size() > most) {
      return absl::DataLossError(
          absl::StrCat("it has more than ", most, " bytes once decompressed"));
    }
    if (progress.end) return result;
    if (progress.consumed == 0 && progress.produced == 0) {
      return absl::DataLossError("its compressed bytes end too early");
    }
  }
}

absl::StatusOr<std::string> DecompressLz4(std::string_view bytes, std::uint64_t most) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0U) {
    return absl::ResourceExhaustedError("out of memory for LZ4");
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  return Run(bytes, most,
             [&](std::string_view in, char* out, std::size_t room) -> absl::StatusOr<Progress> {
               std::size_t consumed = in.size();
               std::size_t produced = room;
               const std::size_t left =
                   LZ4F_decompress(context.get(), out, &produced, in.data(), &consumed, nullptr);
               if (LZ4F_isError(left) != 0U) {
                 return absl::DataLossError(absl::StrCat("LZ4: ", LZ4F_getErrorName(left)));
               }
               return Progress{consumed, produced, left == 0};
             });
}

absl::StatusOr<std::string> DecompressBz2(std::string_view bytes, std::uint64_t most) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) {
    return absl::ResourceExhaustedError("out of memory for bzip2");
  }
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream,
                                                                       &BZ2_bzDecompressEnd);
  return Run(
      bytes, most,
      [&](std::string_view in, char* out, std::size_t room) -> absl::StatusOr<Progress> {
        const auto size = static_cast<unsigned>(
            std::min<std::size_t>(in.size(), std::numeric_limits<unsigned>::max()));
        // The library does not write to its input.
        stream.next_in = const_cast<char*>(in.data());
        stream.avail_in = size;
        stream.next_out = out;
        stream.avail_out = static_cast<unsigned>(room);
        const int result = BZ2_bzDecompress(&stream);
        if (result != BZ_OK && result != BZ_STREAM_END) {
          return absl::DataLossError(absl::StrCat("bzip2 reports error ", result));
        }
        return Progress{size - stream.avail_in, room - stream.avail_out, result == BZ_STREAM_END};
      });
}

absl::StatusOr<std::string> DecompressUpTo(std::string_view name, std::string_view bytes,
                                           std::uint64_t most) {
  if (name == "zstd") return DecompressZstd(bytes, most);
  if (name == "lz4") return DecompressLz4(bytes, most);
  if (name == "bz2") return DecompressBz2(bytes, most);
  if (name.empty() || name == "none") return std::string(bytes);
  return absl::InvalidArgumentError(
      absl::StrCat("its compression \"", std::string(name), "\" must be none, zstd, lz4 or bz2"));
}

}  // namespace

absl::StatusOr<std::string> DecompressZstd(std::string_view bytes, std::uint64_t most) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (context == nullptr) return absl::ResourceExhaustedError("out of memory for zstd");
  return Run(bytes, most,
             [&](std::string_view in, char* out, std::size_t room) -> absl::StatusOr<Progress> {
               ZSTD_inBuffer input{in.data(), in.size(), 0};
               ZSTD_outBuffer output{out, room, 0};
               const std::size_t left = ZSTD_decompressStream(context.get(), &output, &input);
               if (ZSTD_isError(left) != 0U) {
                 return absl::DataLossError(absl::StrCat("zstd: ", ZSTD_getErrorName(left)));
               }
               return Progress{input.pos, output.pos, left == 0};
             });
}

absl::StatusOr<std::string> Decompress(std::string_view name, std::string_view bytes,
                                       std::uint64_t size) {
  HOMING_ASSIGN_OR_RETURN(std::string result, DecompressUpTo(name, bytes, size));
  if (result.size() == size) return result;
  return absl::DataLossError(
      absl::StrCat("it has ", result.size(), " bytes once decompressed, not ", size));
}

}  // namespace homing::client::bag
