#include "homing/landmark/flow_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "homing/flow/median.h"

namespace homing {
namespace {

// Shorter flow is noise: it has no more parallax than this. Pixels.
constexpr double kLeastFlowPx = 0.05;

struct CellFlow {
  int cell = 0;
  double length = 0;
};

// Cell of a midpoint of the magnified field; -1: outside the image.
int CellOf(const FlowField& field, const FlowVector& vector, double magnification) {
  const double x = 0.5 + (vector.MidX() - 0.5 * (field.width - 1)) * magnification / field.width;
  const double y = 0.5 + (vector.MidY() - 0.5 * (field.height - 1)) * magnification / field.height;
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) {
    return -1;
  }
  return static_cast<int>(y * FlowProfile::kRows) * FlowProfile::kColumns +
         static_cast<int>(x * FlowProfile::kColumns);
}

std::vector<CellFlow> FlowByCell(const FlowField& field, double magnification) {
  std::vector<CellFlow> flows;
  flows.reserve(field.vectors.size());
  for (const FlowVector& vector : field.vectors) {
    const double length = vector.Length();
    const int cell = std::isfinite(length) ? CellOf(field, vector, magnification) : -1;
    if (cell >= 0) {
      flows.push_back({cell, std::max(length, kLeastFlowPx)});
    }
  }
  std::ranges::sort(flows, {}, &CellFlow::cell);
  return flows;
}

double MedianLength(const CellFlow* begin, const CellFlow* end) {
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(end - begin));
  std::transform(begin, end, std::back_inserter(lengths),
                 [](const CellFlow& flow) { return flow.length; });
  return Median(lengths);
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

}  // namespace

FlowProfile MakeFlowProfile(const FlowField& field, double magnification) {
  FlowProfile profile;
  const std::vector<CellFlow> flows = FlowByCell(field, magnification);
  if (flows.empty()) {
    return profile;
  }
  const CellFlow* const all_end = flows.data() + flows.size();
  const double median = MedianLength(flows.data(), all_end);
  // Share of this image that the magnified one fills.
  const double filled = std::min(1.0, magnification * magnification);
  const double whole = std::sqrt(static_cast<double>(flows.size()) * FlowProfile::kUsualCount);
  for (const CellFlow* begin = flows.data(); begin != all_end;) {
    const CellFlow* const end = std::find_if(
        begin, all_end, [cell = begin->cell](const CellFlow& f) { return f.cell != cell; });
    profile.cells[static_cast<std::size_t>(begin->cell)] = CodeOf(
        filled * static_cast<double>(end - begin) / whole, MedianLength(begin, end) / median);
    begin = end;
  }
  return profile;
}

}  // namespace homing
