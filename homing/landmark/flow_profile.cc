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

namespace homing {
namespace {

// Shorter flow is noise: it has no more parallax than this. Pixels.
constexpr double kLeastFlowPx = 0.05;
// Nearer than this to the camera, of the median's distance, nothing is taken to be.
constexpr double kLeastDepth = 0.3;
// Those outside the image have a cell of their own, the last.
constexpr int kOutside = FlowProfile::kCells;

int CellOf(double x, double y) {
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) {
    return kOutside;
  }
  return static_cast<int>(y * FlowProfile::kRows) * FlowProfile::kColumns +
         static_cast<int>(x * FlowProfile::kColumns);
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

// A code as the number of bounds that a value reaches: the same codes without logarithms. At 0: the
// code of the least value.
using CodeBounds = std::array<double, FlowProfile::kMaxCode>;

// The least value >= 0 of each code, which grows with the value. Numbers that are not negative have
// the order of their bits.
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

std::uint8_t CodeWithin(const CodeBounds& bounds, double value) {
  std::uint8_t code = 0;
  for (const double bound : bounds) {
    code = static_cast<std::uint8_t>(code + (value >= bound ? 1 : 0));
  }
  return code;
}

std::uint8_t CodeOf(double share, double relative_flow) {
  static const CodeBounds shares = BoundsOf(ShareCodeOf);
  static const CodeBounds flows = BoundsOf(ParallaxCodeOf);
  return static_cast<std::uint8_t>(CodeWithin(flows, relative_flow) << 4 |
                                   CodeWithin(shares, share));
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
      if (i > begin) {
        std::ranges::sort(std::span(sorted).subspan(begin), {}, &Midpoint::length);
      }
      begin = i + 1;
    }
  }
  return sorted;
}

}  // namespace

ProfileMaker::ProfileMaker(const FlowField& field) {
  midpoints_.reserve(field.vectors.size());
  for (const FlowVector& vector : field.vectors) {
    const double length = vector.Length();
    if (std::isfinite(length)) {
      midpoints_.push_back({.x = (vector.MidX() - 0.5 * (field.width - 1)) / field.width,
                            .y = (vector.MidY() - 0.5 * (field.height - 1)) / field.height,
                            .length = std::max(length, kLeastFlowPx)});
    }
  }
  midpoints_ = SortedByLength(midpoints_);
}

FlowProfile ProfileMaker::Make(double magnification) const {
  const std::size_t size = midpoints_.size();
  std::vector<std::uint8_t> cell_of(size);
  std::vector<double> lengths(size);
  std::array<std::uint32_t, kOutside + 1> counts{};
  const double per_median = size == 0 ? 0 : 1 / midpoints_[size / 2].length;
  for (std::size_t i = 0; i < size; ++i) {
    const Midpoint& midpoint = midpoints_[i];
    // Nearness to the path, of the median's; what is near changes more than what is far.
    const double near = midpoint.length * per_median;
    const double larger =
        magnification / std::max(kLeastDepth, magnification + near * (1 - magnification));
    const auto cell =
        static_cast<std::size_t>(CellOf(0.5 + midpoint.x * larger, 0.5 + midpoint.y * larger));
    lengths[i] = midpoint.length * larger;
    cell_of[i] = static_cast<std::uint8_t>(cell);
    ++counts[cell];
  }
  // By cell, shortest first: the median is the one in the middle. The same of all inside.
  std::array<std::uint32_t, kOutside + 1> ends{};
  std::exclusive_scan(counts.begin(), counts.end(), ends.begin(), 0U);
  std::vector<double> by_cell(size);
  std::vector<double> inside(size + 1);
  std::size_t inside_count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    by_cell[ends[cell_of[i]]++] = lengths[i];
    inside[inside_count] = lengths[i];
    inside_count += cell_of[i] != kOutside ? 1 : 0;
  }
  const double median = inside[inside_count / 2];
  // Share of this image that the magnified one fills.
  const double filled = std::min(1.0, magnification * magnification);
  const double whole = std::sqrt(static_cast<double>(inside_count) * FlowProfile::kUsualCount);
  FlowProfile profile;
  for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
    if (counts[cell] > 0) {
      const double middle = by_cell[ends[cell] - counts[cell] + counts[cell] / 2];
      profile.cells[cell] = CodeOf(filled * counts[cell] / whole, middle / median);
    }
  }
  return profile;
}

}  // namespace homing
