#include "homing/landmark/flow_profile.h"

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

// Shorter flow is noise: it has no more parallax than this. Pixels.
constexpr double kLeastFlowPx = 0.05;
// Nearer than this to the camera, of the median's distance, nothing is taken to be.
constexpr double kLeastDepth = 0.3;
constexpr int kOutside = -1;

int CellOf(double x, double y) {
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) {
    return kOutside;
  }
  return static_cast<int>(y * FlowProfile::kRows) * FlowProfile::kColumns +
         static_cast<int>(x * FlowProfile::kColumns);
}

std::uint8_t CodeOf(double share, double relative_flow) {
  const auto share_code = std::min<long>(
      FlowProfile::kMaxCode, std::lround(FlowProfile::kSharePerRoot * std::sqrt(share)));
  const auto parallax_code =
      std::clamp<long>(FlowProfile::kMedianParallax +
                           std::lround(FlowProfile::kParallaxPerOctave * std::log2(relative_flow)),
                       1, FlowProfile::kMaxCode);
  return static_cast<std::uint8_t>(parallax_code << 4 | share_code);
}

struct CellFlow {
  int count = 0;
  int seen = 0;
  double median = 0;
};

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
  std::ranges::sort(midpoints_, {}, &Midpoint::length);
}

FlowProfile ProfileMaker::Make(double magnification) const {
  std::vector<int> cell_of;
  cell_of.reserve(midpoints_.size());
  std::vector<double> lengths;
  lengths.reserve(midpoints_.size());
  std::array<CellFlow, FlowProfile::kCells> cells{};
  CellFlow all;
  const double per_median = midpoints_.empty() ? 0 : 1 / midpoints_[midpoints_.size() / 2].length;
  for (const Midpoint& midpoint : midpoints_) {
    // Nearness to the path, of the median's; what is near changes more than what is far.
    const double near = midpoint.length * per_median;
    const double larger =
        magnification / std::max(kLeastDepth, magnification + near * (1 - magnification));
    const int cell = CellOf(0.5 + midpoint.x * larger, 0.5 + midpoint.y * larger);
    lengths.push_back(midpoint.length * larger);
    cell_of.push_back(cell);
    if (cell != kOutside) {
      ++all.count;
      ++cells[static_cast<std::size_t>(cell)].count;
    }
  }
  // Shortest first: the median is the one in the middle.
  const auto pass = [](CellFlow& flow, double length) {
    if (flow.seen++ == flow.count / 2) flow.median = length;
  };
  for (std::size_t i = 0; i < midpoints_.size(); ++i) {
    if (cell_of[i] != kOutside) {
      pass(all, lengths[i]);
      pass(cells[static_cast<std::size_t>(cell_of[i])], lengths[i]);
    }
  }
  // Share of this image that the magnified one fills.
  const double filled = std::min(1.0, magnification * magnification);
  const double whole = std::sqrt(static_cast<double>(all.count) * FlowProfile::kUsualCount);
  FlowProfile profile;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const CellFlow& flow = cells[cell];
    if (flow.count > 0) {
      profile.cells[cell] = CodeOf(filled * flow.count / whole, flow.median / all.median);
    }
  }
  return profile;
}

}  // namespace homing
