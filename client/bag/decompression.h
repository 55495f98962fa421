// The compressions of bags. They use libzstd, liblz4 and libbz2.
#ifndef CLIENT_BAG_DECOMPRESSION_H_
#define CLIENT_BAG_DECOMPRESSION_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace homing::client::bag {

// By the names that bags use: "" and "none", "zstd", "lz4" (frames), "bz2". DATA_LOSS: the bytes
// are damaged, end too early, or are not `size` bytes long once decompressed. INVALID_ARGUMENT:
// another name. Memory grows with the decompressed bytes, not with `size`.
absl::StatusOr<std::string> Decompress(std::string_view name, std::string_view bytes,
                                       std::uint64_t size);

// A zstd frame, `most` bytes long at most once decompressed.
absl::StatusOr<std::string> DecompressZstd(std::string_view bytes, std::uint64_t most);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_DECOMPRESSION_H_
