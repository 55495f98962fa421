#include "homing/landmark/profile_code.h"

#include "absl/strings/str_cat.h"

namespace homing {
namespace {

constexpr std::size_t kBitmapBytes = FlowProfile::kCells / 8;
static_assert(kBitmapBytes * 8 == FlowProfile::kCells);

absl::Status NotAProfile(std::size_t size) {
  return absl::InvalidArgumentError(
      absl::StrCat("flow profile of ", size, " bytes is not one that this program writes"));
}

}  // namespace

std::string EncodeProfile(const FlowProfile& profile) {
  if (profile == FlowProfile{}) {
    return "";
  }
  std::string bytes(kBitmapBytes, '\0');
  for (std::size_t cell = 0; cell < profile.cells.size(); ++cell) {
    if (profile.cells[cell] != 0) {
      bytes[cell / 8] = static_cast<char>(bytes[cell / 8] | 1 << cell % 8);
      bytes.push_back(static_cast<char>(profile.cells[cell]));
    }
  }
  return bytes;
}

absl::StatusOr<FlowProfile> DecodeProfile(std::string_view bytes) {
  FlowProfile profile;
  if (bytes.empty()) {
    return profile;
  }
  if (bytes.size() <= kBitmapBytes) {
    return NotAProfile(bytes.size());
  }
  std::size_t next = kBitmapBytes;
  for (std::size_t cell = 0; cell < profile.cells.size(); ++cell) {
    if ((bytes[cell / 8] >> cell % 8 & 1) != 0) {
      if (next == bytes.size() || bytes[next] == 0) {
        return NotAProfile(bytes.size());
      }
      profile.cells[cell] = static_cast<std::uint8_t>(bytes[next++]);
    }
  }
  return next == bytes.size() ? absl::StatusOr<FlowProfile>(profile) : NotAProfile(bytes.size());
}

}  // namespace homing
