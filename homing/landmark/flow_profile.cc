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

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Shorter flow is noise: it has no more parallax than this. Pixels.
constexpr double kLeastFlowPx = 0.05;
// Length of a vector that is left out.
constexpr double kNotFinite = std::numeric_limits<double>::infinity();
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

// As many as are ranked at once.
constexpr std::size_t kRanked = 32;
// Of what is ranked by counting, at most; the bits of an index.
constexpr std::size_t kFew = 1024;

// Integers in the order of positive numbers, but for those that are close; each another one.
HOMING_VECTOR_CLONES
void FillKeys(const double* values, std::size_t size, std::int32_t* __restrict keys) {
  for (std::size_t i = 0; i < size; ++i) {
    const auto key = std::bit_cast<std::int32_t>(static_cast<float>(values[i]));
    keys[i] = (key & ~static_cast<std::int32_t>(kFew - 1)) | static_cast<std::int32_t>(i);
  }
}

// Of each key the number of lesser ones. REQUIRES: size is a multiple of kRanked.
HOMING_VECTOR_CLONES
void FillRanks(const std::int32_t* keys, std::size_t size, std::int32_t* __restrict ranks) {
  for (std::size_t begin = 0; begin < size; begin += kRanked) {
    std::array<std::int32_t, kRanked> ranked;
    std::array<std::int32_t, kRanked> less{};
    for (std::size_t i = 0; i < kRanked; ++i) ranked[i] = keys[begin + i];
    for (std::size_t other = 0; other < size; ++other) {
      const std::int32_t key = keys[other];
      for (std::size_t i = 0; i < kRanked; ++i) less[i] += key < ranked[i] ? 1 : 0;
    }
    for (std::size_t i = 0; i < kRanked; ++i) ranks[begin + i] = less[i];
  }
}

// Indices of positive numbers, the least first. Where there are few, each one's place is counted:
// no step depends on what is found, so that it takes a quarter of the time of sorting.
std::vector<std::int32_t> OrderOf(std::span<const double> values) {
  std::vector<std::int32_t> order(values.size());
  const auto value_of = [values](std::int32_t i) { return values[static_cast<std::size_t>(i)]; };
  if (values.size() > kFew) {
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, value_of);
    return order;
  }
  const std::size_t padded = (values.size() + kRanked - 1) / kRanked * kRanked;
  std::vector<std::int32_t> keys(padded, std::numeric_limits<std::int32_t>::max());
  std::vector<std::int32_t> ranks(padded);
  FillKeys(values.data(), values.size(), keys.data());
  FillRanks(keys.data(), padded, ranks.data());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[static_cast<std::size_t>(ranks[i])] = static_cast<std::int32_t>(i);
  }
  // Those that are close are beside each other: they change places until they are in order.
  for (std::size_t i = 1; i < order.size(); ++i) {
    for (std::size_t at = i; at > 0 && value_of(order[at]) < value_of(order[at - 1]); --at) {
      std::swap(order[at], order[at - 1]);
    }
  }
  return order;
}

}  // namespace

HOMING_VECTOR_CLONES
void ProfileMaker::FillMidpoints(const FlowField& field, double* __restrict x, double* __restrict y,
                                 double* __restrict lengths) {
  const FlowVector* const from = field.vectors.data();
  const double width = field.width, height = field.height;
  const double middle_x = 0.5 * (width - 1), middle_y = 0.5 * (height - 1);
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    const double length = from[i].Length();
    x[i] = (from[i].MidX() - middle_x) / width;
    y[i] = (from[i].MidY() - middle_y) / height;
    const double most = length <= std::numeric_limits<double>::max() ? length : kNotFinite;
    lengths[i] = most < kLeastFlowPx ? kLeastFlowPx : most;
  }
}

ProfileMaker::ProfileMaker(const FlowField& field) {
  Midpoints all(field.vectors.size());
  FillMidpoints(field, all.x.data(), all.y.data(), all.lengths.data());
  std::vector<std::int32_t> order = OrderOf(all.lengths);
  while (!order.empty() && all.lengths[static_cast<std::size_t>(order.back())] == kNotFinite) {
    order.pop_back();
  }
  midpoints_ = Midpoints(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto from = static_cast<std::size_t>(order[i]);
    midpoints_.x[i] = all.x[from];
    midpoints_.y[i] = all.y[from];
    midpoints_.lengths[i] = all.lengths[from];
  }
}

HOMING_VECTOR_CLONES
void ProfileMaker::Magnify(const Midpoints& midpoints, double magnification, double per_median,
                           std::int32_t* __restrict cells, double* __restrict lengths) {
  const double* const from_x = midpoints.x.data();
  const double* const from_y = midpoints.y.data();
  const double* const from = midpoints.lengths.data();
  const std::size_t size = midpoints.lengths.size();
  for (std::size_t i = 0; i < size; ++i) {
    // Nearness to the path, of the median's; what is near changes more than what is far.
    const double near = from[i] * per_median;
    const double depth = magnification + near * (1 - magnification);
    const double larger = magnification / (depth > kLeastDepth ? depth : kLeastDepth);
    lengths[i] = from[i] * larger;
    const double x = 0.5 + from_x[i] * larger;
    const double y = 0.5 + from_y[i] * larger;
    const bool inside = (x >= 0) & (x < 1) & (y >= 0) & (y < 1);
    const std::int32_t cell =
        PartOf(y, FlowProfile::kRows) * FlowProfile::kColumns + PartOf(x, FlowProfile::kColumns);
    cells[i] = inside ? cell : kOutside;
  }
}

FlowProfile ProfileMaker::Make(double magnification) const {
  const std::size_t size = midpoints_.lengths.size();
  std::vector<std::int32_t> cell_of(size);
  std::vector<double> lengths(size);
  const double per_median = size == 0 ? 0 : 1 / midpoints_.lengths[size / 2];
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
