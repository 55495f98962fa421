#include "client/source/image_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"

namespace homing::client {
namespace {

constexpr std::array<const char*, 9> kImageEndings = {".jpg", ".jpeg", ".png",  ".pgm", ".ppm",
                                                      ".bmp", ".tif",  ".tiff", ".webp"};
constexpr std::size_t kNanosecondDigits = 9;

bool IsDigit(char c) { return absl::ascii_isdigit(static_cast<unsigned char>(c)); }

// The run of digits at `i`, without leading zeros; moves `i` behind it.
std::string TakeNumber(const std::string& text, std::size_t& i) {
  while (i < text.size() && text[i] == '0') ++i;
  const std::size_t begin = i;
  while (i < text.size() && IsDigit(text[i])) ++i;
  return text.substr(begin, i - begin);
}

std::string Stem(const std::string& path) { return std::filesystem::path(path).stem().string(); }

// A number as its digits before (without leading zeros) and behind the point (without trailing
// ones).
struct Decimal {
  std::string whole;
  std::string fraction;
  bool has_point = false;
};

std::optional<Decimal> ParseDecimal(const std::string& text) {
  std::size_t i = 0;
  if (text.empty() || !IsDigit(text[0])) return std::nullopt;
  Decimal decimal;
  decimal.whole = TakeNumber(text, i);
  if (i == text.size()) return decimal;
  if (text[i] != '.' || i + 1 == text.size()) return std::nullopt;
  decimal.has_point = true;
  decimal.fraction = text.substr(i + 1);
  if (!std::all_of(decimal.fraction.begin(), decimal.fraction.end(), IsDigit)) return std::nullopt;
  decimal.fraction.erase(decimal.fraction.find_last_not_of('0') + 1);
  return decimal;
}

bool DecimalLess(const Decimal& a, const Decimal& b) {
  if (a.whole.size() != b.whole.size()) return a.whole.size() < b.whole.size();
  if (a.whole != b.whole) return a.whole < b.whole;
  return a.fraction < b.fraction;
}

// Empty unless each whole stem is a decimal number and one has a point.
std::vector<Decimal> DecimalStems(const std::vector<std::string>& paths) {
  std::vector<Decimal> decimals;
  bool has_point = false;
  for (const std::string& path : paths) {
    const auto decimal = ParseDecimal(Stem(path));
    if (!decimal) return {};
    has_point = has_point || decimal->has_point;
    decimals.push_back(*decimal);
  }
  return has_point ? decimals : std::vector<Decimal>();
}

std::optional<std::int64_t> Nanoseconds(const Decimal& seconds) {
  std::string digits = seconds.fraction.substr(0, kNanosecondDigits);
  digits.resize(kNanosecondDigits, '0');
  std::int64_t value = 0;
  if (!absl::SimpleAtoi(absl::StrCat(seconds.whole, digits), &value)) return std::nullopt;
  return value;
}

// The last number in a name; nothing without one.
std::optional<std::int64_t> LastNumber(const std::string& stem) {
  std::size_t end = stem.size();
  while (end > 0 && !IsDigit(stem[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && IsDigit(stem[begin - 1])) --begin;
  std::int64_t value = 0;
  if (begin == end || !absl::SimpleAtoi(stem.substr(begin, end - begin), &value)) {
    return std::nullopt;
  }
  return value;
}

bool Ascends(const std::vector<std::int64_t>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

// Nanoseconds a unit of a clock's whole numbers; 0: too small for a clock, or too large for 64 bits
// of nanoseconds.
std::int64_t UnitOfClock(std::int64_t value) {
  constexpr std::int64_t kMilliseconds = 100'000'000'000;
  std::int64_t unit = 0;
  if (value >= kMilliseconds) unit = 1'000'000;
  if (value >= kMilliseconds * 1'000) unit = 1'000;
  if (value >= kMilliseconds * 1'000'000) unit = 1;
  return unit == 0 || value <= std::numeric_limits<std::int64_t>::max() / unit ? unit : 0;
}

FrameKeys KeysOfNumbers(std::vector<std::int64_t> values) {
  if (!Ascends(values)) return {};
  const std::int64_t unit = UnitOfClock(values.front());
  if (unit == 0 || unit != UnitOfClock(values.back())) {
    return {FrameKeys::Kind::kNumber, std::move(values)};
  }
  for (std::int64_t& value : values) value *= unit;
  return {FrameKeys::Kind::kTime, std::move(values)};
}

}  // namespace

bool HasEnding(const std::string& path, std::span<const char* const> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const char* ending) { return absl::EndsWithIgnoreCase(path, ending); });
}

bool HasImageEnding(const std::string& path) { return HasEnding(path, kImageEndings); }

std::optional<std::int64_t> ParseTime(const std::string& text) {
  const auto decimal = ParseDecimal(text);
  if (!decimal) return std::nullopt;
  std::int64_t value = 0;
  const bool whole = !decimal->has_point && absl::SimpleAtoi(text, &value);
  const std::int64_t unit = whole ? UnitOfClock(value) : 0;
  if (unit == 0) return Nanoseconds(*decimal);
  return value * unit;
}

bool NaturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[j])) {
      const std::string m = TakeNumber(a, i);
      const std::string n = TakeNumber(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i == a.size()) != (j == b.size())) return i == a.size();
  return a < b;  // 01.png and 1.png: some fixed order
}

void SortByName(std::vector<std::string>* paths) {
  std::sort(paths->begin(), paths->end(), NaturalLess);
  const std::vector<Decimal> decimals = DecimalStems(*paths);
  if (decimals.empty()) return;
  std::vector<std::size_t> order(paths->size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return DecimalLess(decimals[a], decimals[b]);
  });
  std::vector<std::string> sorted;
  sorted.reserve(order.size());
  for (const std::size_t i : order) sorted.push_back((*paths)[i]);
  *paths = std::move(sorted);
}

FrameKeys KeysOfNames(const std::vector<std::string>& paths) {
  std::vector<std::int64_t> values;
  const std::vector<Decimal> decimals = DecimalStems(paths);
  for (const Decimal& decimal : decimals) {
    const auto value = Nanoseconds(decimal);
    if (!value) return {};
    values.push_back(*value);
  }
  if (!decimals.empty()) {
    return Ascends(values) ? FrameKeys{FrameKeys::Kind::kTime, std::move(values)} : FrameKeys();
  }
  for (const std::string& path : paths) {
    const auto value = LastNumber(Stem(path));
    if (!value) return {};
    values.push_back(*value);
  }
  return values.empty() ? FrameKeys() : KeysOfNumbers(std::move(values));
}

}  // namespace homing::client
