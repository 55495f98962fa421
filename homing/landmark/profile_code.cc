#include "homing/landmark/profile_code.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"

namespace homing {
namespace {

// The first format: 12 x 8 cells, each vector in one cell; a bitmap of the cells with vectors, then
// one byte for each of these.
constexpr int kOldColumns = 12;
constexpr int kOldRows = 8;
constexpr std::size_t kOldCells = kOldColumns * kOldRows;
constexpr std::size_t kBitmapBytes = kOldCells / 8;
constexpr std::size_t kOldMost = kBitmapBytes + kOldCells;
// The present format: the odometer reading, a nibble of count code a cell, a nibble of parallax
// code for two cells. Longer than any of the first format.
constexpr std::size_t kOdometerBytes = 8;
constexpr std::size_t kCountBytes = FlowProfile::kCells / 2;
constexpr std::size_t kParallaxBytes = FlowProfile::kCells / 4;
constexpr std::size_t kBytes = kOdometerBytes + kCountBytes + kParallaxBytes;
// The format before it had no turn.
constexpr std::size_t kTurnAt = 6;
constexpr std::size_t kTurnBytes = 2;
constexpr std::size_t kBytesWithoutTurn = kBytes - kTurnBytes;
static_assert(kBytesWithoutTurn > kOldMost && kBytes == kProfileBytes);

absl::Status NotAProfile(std::size_t size) {
  return absl::InvalidArgumentError(absl::StrCat("flow profile: ", size, " bytes must be ", kBytes,
                                                 ", or an older profile of ", kBytesWithoutTurn,
                                                 " or 13 to ", kOldMost, " bytes"));
}

using OldCells = std::array<std::uint8_t, kOldCells>;

absl::StatusOr<OldCells> DecodeOldCells(std::string_view bytes) {
  OldCells cells{};
  std::size_t next = kBitmapBytes;
  for (std::size_t cell = 0; cell < kOldCells; ++cell) {
    if ((bytes[cell / 8] >> cell % 8 & 1) != 0) {
      if (next == bytes.size() || bytes[next] == 0) {
        return NotAProfile(bytes.size());
      }
      cells[cell] = static_cast<std::uint8_t>(bytes[next++]);
    }
  }
  if (next != bytes.size()) {
    return NotAProfile(bytes.size());
  }
  return cells;
}

// Fraction of the cell `at` of `cells` that the cell `other` of `others` covers, along one axis.
double Overlap(int at, int cells, int other, int others) {
  const double first =
      std::max(static_cast<double>(at) / cells, static_cast<double>(other) / others);
  const double last = std::min((at + 1.0) / cells, (other + 1.0) / others);
  return std::max(0.0, last - first) * others;
}

// Cells of the first format as those of the present one, by area: codes stand for roots of counts.
FlowProfile Resample(const OldCells& old) {
  FlowProfile profile;
  for (int row = 0; row < FlowProfile::kRows; ++row) {
    for (int pair = 0; pair < FlowProfile::kColumns; pair += 2) {
      double parallax = 0, both = 0;
      std::array<int, 2> count_codes{};
      for (int i = 0; i < 2; ++i) {
        double counts = 0;
        for (std::size_t cell = 0; cell < kOldCells; ++cell) {
          const int old_row = static_cast<int>(cell) / kOldColumns;
          const int old_column = static_cast<int>(cell) % kOldColumns;
          const double code = old[cell] & 15;
          const double part = Overlap(row, FlowProfile::kRows, old_row, kOldRows) *
                              Overlap(pair + i, FlowProfile::kColumns, old_column, kOldColumns) *
                              code * code;
          counts += part;
          parallax += part * (old[cell] >> 4);
        }
        both += counts;
        count_codes[static_cast<std::size_t>(i)] =
            static_cast<int>(std::min<long>(15, std::lround(std::sqrt(counts))));
      }
      const int code =
          both > 0 ? std::clamp(static_cast<int>(std::lround(parallax / both)), 1, 15) : 0;
      const int cell = row * FlowProfile::kColumns + pair;
      const auto first = profile.cells.begin() + cell;
      std::ranges::transform(count_codes, first, [code](int count) {
        return static_cast<std::uint8_t>(code << 4 | count);
      });
    }
  }
  return profile;
}

void PutSigned(std::int16_t value, std::string& bytes) {
  bytes.push_back(static_cast<char>(static_cast<std::uint16_t>(value) & 0xff));
  bytes.push_back(static_cast<char>(static_cast<std::uint16_t>(value) >> 8));
}

std::int16_t SignedAt(std::string_view bytes, std::size_t at) {
  const auto low = static_cast<std::uint8_t>(bytes[at]);
  const auto high = static_cast<std::uint8_t>(bytes[at + 1]);
  return static_cast<std::int16_t>(low | high << 8);
}

int NibbleAt(std::string_view bytes, std::size_t first, std::size_t nibble) {
  const auto byte = static_cast<std::uint8_t>(bytes[first + nibble / 2]);
  return nibble % 2 == 0 ? byte & 15 : byte >> 4;
}

}  // namespace

std::string EncodeProfile(const FlowProfile& profile) {
  if (profile == FlowProfile{}) {
    return "";
  }
  std::string bytes;
  bytes.reserve(kBytes);
  PutSigned(profile.odometer.median_x, bytes);
  PutSigned(profile.odometer.expansion, bytes);
  bytes.push_back(static_cast<char>(profile.odometer.length_code));
  bytes.push_back(static_cast<char>(profile.odometer.spread_code));
  PutSigned(profile.odometer.turn_code, bytes);
  for (int cell = 0; cell < FlowProfile::kCells; cell += 2) {
    bytes.push_back(
        static_cast<char>(profile.count_code(cell) | profile.count_code(cell + 1) << 4));
  }
  for (int cell = 0; cell < FlowProfile::kCells; cell += 4) {
    bytes.push_back(
        static_cast<char>(profile.parallax_code(cell) | profile.parallax_code(cell + 2) << 4));
  }
  return bytes;
}

absl::StatusOr<FlowProfile> DecodeProfile(std::string_view bytes) {
  FlowProfile profile;
  if (bytes.empty()) {
    return profile;
  }
  if (bytes.size() > kBitmapBytes && bytes.size() <= kOldMost) {
    const auto old = DecodeOldCells(bytes);
    return old.ok() ? absl::StatusOr<FlowProfile>(Resample(*old)) : old.status();
  }
  if (bytes.size() == kBytesWithoutTurn) {
    std::string with_turn(bytes);
    with_turn.insert(kTurnAt, kTurnBytes, 0);
    return DecodeProfile(with_turn);
  }
  if (bytes.size() != kBytes) {
    return NotAProfile(bytes.size());
  }
  profile.odometer = {.median_x = SignedAt(bytes, 0),
                      .expansion = SignedAt(bytes, 2),
                      .length_code = static_cast<std::uint8_t>(bytes[4]),
                      .spread_code = static_cast<std::uint8_t>(bytes[5]),
                      .turn_code = SignedAt(bytes, kTurnAt)};
  for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
    const int count = NibbleAt(bytes, kOdometerBytes, cell);
    const int parallax = NibbleAt(bytes, kOdometerBytes + kCountBytes, cell / 2);
    profile.cells[cell] = static_cast<std::uint8_t>(parallax << 4 | count);
  }
  if (profile == FlowProfile{}) {
    return NotAProfile(bytes.size());
  }
  return profile;
}

}  // namespace homing
