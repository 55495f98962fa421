#include "client/source/image_list.h"

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/source/image_names.h"
#include "homing/base/file_text.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::array<const char*, 3> kEndings = {".txt", ".csv", ".lst"};

struct Entry {
  std::int64_t time_ns = 0;
  std::string file;
};

std::optional<Entry> ParseEntry(const std::string& line) {
  // A name may have spaces: only the first or the last part is the time.
  const bool commas = absl::StrContains(line, ',');
  const std::string separators = commas ? "," : " \t";
  const std::size_t first = line.find_first_of(separators);
  const std::size_t last = line.find_last_of(separators);
  if (first == std::string::npos) return std::nullopt;
  const auto part = [&line](std::size_t from, std::size_t to) {
    return std::string(absl::StripAsciiWhitespace(line.substr(from, to - from)));
  };
  if (const auto time = ParseTime(part(0, first)))
    return Entry{*time, part(first + 1, line.size())};
  if (const auto time = ParseTime(part(last + 1, line.size()))) return Entry{*time, part(0, last)};
  return std::nullopt;
}

std::string PlaceOf(const std::filesystem::path& folder, const std::string& file) {
  std::error_code error;
  const std::filesystem::path beside = folder / file;
  const std::filesystem::path below = folder / "data" / file;
  const bool in_data =
      !std::filesystem::exists(beside, error) && std::filesystem::exists(below, error);
  return (in_data ? below : beside).string();
}

absl::Status WrongLine(const std::string& path, std::size_t number, const std::string& line,
                       const std::string& rule) {
  return absl::InvalidArgumentError(
      absl::StrCat(path, ", line ", number, ": ", line.substr(0, 80), " ", rule));
}

}  // namespace

bool HasListEnding(const std::string& path) { return HasEnding(path, kEndings); }

absl::StatusOr<ImageList> ReadImageList(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  ImageList list;
  std::size_t number = 0;
  std::size_t entries = 0;
  for (const auto& raw : absl::StrSplit(text, '\n')) {
    ++number;
    const std::string line(absl::StripAsciiWhitespace(raw));
    if (line.empty() || line[0] == '#') continue;
    const std::optional<Entry> entry = ParseEntry(line);
    // The first line may hold headings.
    if (!entry && entries++ == 0 && !HasImageEnding(line)) continue;
    if (!entry || entry->file.empty()) {
      return WrongLine(path, number, line, "must be a time and the file of an image");
    }
    ++entries;
    if (!list.times_ns.empty() && entry->time_ns <= list.times_ns.back()) {
      return WrongLine(path, number, line, "must have a later time than the line before");
    }
    list.times_ns.push_back(entry->time_ns);
    list.paths.push_back(PlaceOf(folder, entry->file));
  }
  if (list.paths.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " names no images: each line must be a time and the file of an image"));
  }
  return list;
}

}  // namespace homing::client
