#include "client/source/source_mark.h"

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// FNV-1a: the same on every machine and in every version.
std::uint64_t Hash(std::uint64_t hash, std::string_view bytes) {
  for (const char c : bytes) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  }
  return (hash ^ bytes.size()) * 1099511628211U;
}

std::string PlaceOf(const std::string& source) {
  std::error_code error;
  if (source.empty() || absl::StartsWith(source, "sim:")) return source;
  const auto place = std::filesystem::weakly_canonical(source, error);
  return error ? source : place.string();
}

}  // namespace

absl::StatusOr<std::string> MarkOfSource(const std::string& left, const std::string& right,
                                         const FrameChoice& choice, CameraInstants& instants) {
  if (instants.live()) return kLiveMark;
  HOMING_ASSIGN_OR_RETURN(const CameraInstants::Instant* const first, instants.Peek());
  if (first == nullptr) return absl::InvalidArgumentError("the sources have no frame");
  std::uint64_t hash = 14695981039346656037U;
  hash = Hash(Hash(hash, PlaceOf(left)), PlaceOf(right));
  hash = Hash(hash, absl::StrCat(choice.every, " ", choice.fps));
  for (const auto& frame : first->frames) hash = Hash(hash, frame ? frame->data : "");
  return absl::StrFormat("%016x", hash);
}

std::string WriterWithMark(const std::string& writer, const std::string& mark, std::int64_t base) {
  return absl::StrCat(writer, "#", mark, base == 0 ? "" : absl::StrCat("@", base));
}

std::int64_t BaseOfMark(const std::string& source_mark, const std::string& mark) {
  if (mark == kLiveMark || !absl::StartsWith(source_mark, mark)) return -1;
  if (source_mark == mark) return 0;
  std::int64_t base = -1;
  const std::string rest = source_mark.substr(mark.size());
  if (rest[0] != '@' || !absl::SimpleAtoi(rest.substr(1), &base)) return -1;
  return base;
}

}  // namespace homing::client
