#include "homing/landmark/flow_profile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "homing/vector_clones.h"

namespace homing {
namespace {

// Shorter flow is noise: it has no more parallax than this. Pixels.
constexpr double kLeastFlowPx = 0.05;
// Nearer than this to the camera, of the median's distance, nothing is taken to be.
constexpr double kLeastDepth = 0.3;
// Those outside the image have a cell of their own, the last.
constexpr int kOutside = FlowProfile::kCells;

// Which of so many parts of 0..1 holds `at`; where none does, any.
inline std::int32_t PartOf(double at, int parts) {
  const double least = at > 0 ? at : 0;
  return static_cast<std::int32_t>((least < 1 ? least : 0) * parts);
}

long ShareCodeOf(double share) {
  return std::min<long>(FlowProfile::kMaxCode,
                        std::lround(FlowProfile::kSharePerRoot * std::sqrt(share)));
}

long ParallaxCodeOf(double relative_flow) {
  return std::clamp<long>(
      FlowProfile::kMedianParallax +
          std::lround(FlowProfile::kParallaxPerOctave * std::log2(relative_flow)),
      1, FlowProfile::kMaxCode);
}

// A code is the number of bounds that a value reaches: the same codes without logarithms.
using CodeBounds = std::array<double, FlowProfile::kMaxCode>;

// The n-th: the least value, 0 or more, whose code is above n; codes grow with the value. Found by
// bisection of its bits, which have the order of the values.
CodeBounds BoundsOf(long (*code_of)(double)) {
  CodeBounds bounds;
  for (std::size_t code = 0; code < bounds.size(); ++code) {
    std::uint64_t below = 0;
    auto reached = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::max());
    while (below < reached) {
      const std::uint64_t middle = below + (reached - below) / 2;
      if (code_of(std::bit_cast<double>(middle)) > static_cast<long>(code)) {
        reached = middle;
      } else {
        below = middle + 1;
      }
    }
    bounds[code] = std::bit_cast<double>(reached);
  }
  return bounds;
}

using CellValues = std::array<double, FlowProfile::kCells>;
using CellCodes = std::array<std::int64_t, FlowProfile::kCells>;

HOMING_VECTOR_CLONES
void FindCodes(const CodeBounds& bounds, const CellValues& values, CellCodes& codes) {
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    std::int64_t code = 0;
    for (const double bound : bounds) {
      code += values[cell] >= bound ? 1 : 0;
    }
    codes[cell] = code;
  }
}

// Of a number that is not negative: an integer in the order of the numbers, of 16 bits of which the
// least of all is 0 and the greatest the largest.
class CoarseRank {
 public:
  CoarseRank(float least, float greatest) : least_(KeyOf(least)) {
    while ((KeyOf(greatest) - least_) >> shift_ > 0xffff) {
      ++shift_;
    }
  }
  std::uint32_t operator()(float value) const { return (KeyOf(value) - least_) >> shift_; }

 private:
  static std::uint32_t KeyOf(float value) { return std::bit_cast<std::uint32_t>(value); }

  std::uint32_t least_;
  int shift_ = 0;
};

// As std::sort by length, in half of the time: two rounds of counting, whose steps do not depend on
// what is found, then what is left to compare.
template <typename Midpoint>
std::vector<Midpoint> SortedByLength(const std::vector<Midpoint>& midpoints) {
  if (midpoints.empty()) {
    return {};
  }
  const auto [least, greatest] = std::ranges::minmax(midpoints, {}, &Midpoint::length);
  const CoarseRank rank(static_cast<float>(least.length), static_cast<float>(greatest.length));
  // Rank above index.
  std::vector<std::uint64_t> from(midpoints.size());
  std::vector<std::uint64_t> to(midpoints.size());
  std::array<std::array<std::uint32_t, 257>, 2> begins{};
  for (std::size_t i = 0; i < midpoints.size(); ++i) {
    const std::uint32_t ranked = rank(static_cast<float>(midpoints[i].length));
    from[i] = std::uint64_t{ranked} << 32 | i;
    ++begins[0][(ranked & 0xff) + 1];
    ++begins[1][(ranked >> 8) + 1];
  }
  for (std::size_t digit = 0; digit < begins.size(); ++digit) {
    auto& begin = begins[digit];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const std::uint64_t ranked : from) {
      to[begin[ranked >> (32 + 8 * digit) & 0xff]++] = ranked;
    }
    std::swap(from, to);
  }
  std::vector<Midpoint> sorted;
  sorted.reserve(midpoints.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    sorted.push_back(midpoints[from[i] & 0xffffffff]);
    if (i + 1 == from.size() || from[i + 1] >> 32 != from[i] >> 32) {
      const auto alike = std::span(sorted).subspan(begin);
      if (alike.size() > 1 && !std::ranges::is_sorted(alike, {}, &Midpoint::length)) {
        std::ranges::sort(alike, {}, &Midpoint::length);
      }
      begin = i + 1;
    }
  }
  return sorted;
}

}  // namespace

HOMING_VECTOR_CLONES
void ProfileMaker::FillMidpoints(const FlowField& field, Midpoint* __restrict midpoints) {
  const FlowVector* const from = field.vectors.data();
  const double width = field.width, height = field.height;
  const double middle_x = 0.5 * (width - 1), middle_y = 0.5 * (height - 1);
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    const double length = from[i].Length();
    midpoints[i].x = (from[i].MidX() - middle_x) / width;
    midpoints[i].y = (from[i].MidY() - middle_y) / height;
    midpoints[i].length = length < kLeastFlowPx ? kLeastFlowPx : length;
  }
}

ProfileMaker::ProfileMaker(const FlowField& field) : midpoints_(field.vectors.size()) {
  FillMidpoints(field, midpoints_.data());
  std::erase_if(midpoints_, [](const Midpoint& m) { return !std::isfinite(m.length); });
  midpoints_ = SortedByLength(midpoints_);
}

HOMING_VECTOR_CLONES
void ProfileMaker::Magnify(std::span<const Midpoint> midpoints, double magnification,
                           double per_median, std::int32_t* __restrict cells,
                           double* __restrict lengths) {
  const Midpoint* const from = midpoints.data();
  for (std::size_t i = 0; i < midpoints.size(); ++i) {
    // Nearness to the path, of the median's; what is near changes more than what is far.
    const double near = from[i].length * per_median;
    const double depth = magnification + near * (1 - magnification);
    const double larger = magnification / (depth > kLeastDepth ? depth : kLeastDepth);
    lengths[i] = from[i].length * larger;
    const double x = 0.5 + from[i].x * larger;
    const double y = 0.5 + from[i].y * larger;
    const bool inside = (x >= 0) & (x < 1) & (y >= 0) & (y < 1);
    const std::int32_t cell =
        PartOf(y, FlowProfile::kRows) * FlowProfile::kColumns + PartOf(x, FlowProfile::kColumns);
    cells[i] = inside ? cell : kOutside;
  }
}

FlowProfile ProfileMaker::Make(double magnification) const {
  const std::size_t size = midpoints_.size();
  std::vector<std::int32_t> cell_of(size);
  std::vector<double> lengths(size);
  const double per_median = size == 0 ? 0 : 1 / midpoints_[size / 2].length;
  Magnify(midpoints_, magnification, per_median, cell_of.data(), lengths.data());
  std::array<std::uint32_t, kOutside + 1> counts{};
  for (const std::int32_t cell : cell_of) {
    ++counts[static_cast<std::size_t>(cell)];
  }
  // By cell, shortest first: the median is the one in the middle. The same of all inside.
  std::array<std::uint32_t, kOutside + 1> ends{};
  std::exclusive_scan(counts.begin(), counts.end(), ends.begin(), 0U);
  std::vector<double> by_cell(size + 1);
  std::vector<double> inside(size + 1);
  std::size_t inside_count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    by_cell[ends[static_cast<std::size_t>(cell_of[i])]++] = lengths[i];
    inside[inside_count] = lengths[i];
    inside_count += cell_of[i] != kOutside ? 1 : 0;
  }
  if (inside_count == 0) return {};
  const double median = inside[inside_count / 2];
  // Share of this image that the magnified one fills.
  const double filled = std::min(1.0, magnification * magnification);
  const double whole = std::sqrt(static_cast<double>(inside_count) * FlowProfile::kUsualCount);
  CellValues shares;
  CellValues flows;
  for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
    shares[cell] = filled * counts[cell] / whole;
    flows[cell] = by_cell[ends[cell] - counts[cell] + counts[cell] / 2] / median;
  }
  static const CodeBounds share_bounds = BoundsOf(ShareCodeOf);
  static const CodeBounds flow_bounds = BoundsOf(ParallaxCodeOf);
  CellCodes share_codes;
  CellCodes flow_codes;
  FindCodes(share_bounds, shares, share_codes);
  FindCodes(flow_bounds, flows, flow_codes);
  FlowProfile profile;
  for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
    const std::int64_t codes = flow_codes[cell] << 4 | share_codes[cell];
    profile.cells[cell] = static_cast<std::uint8_t>(counts[cell] > 0 ? codes : 0);
  }
  return profile;
}

}  // namespace homing
