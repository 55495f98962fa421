#include "homing/landmark/landmark_finder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// The bin of each midpoint; those off the image fall in the outermost bins. -1: a vector that is
// not usable.
HOMING_VECTOR_CLONES
void FindBins(std::span<const FlowVector> vectors, int width, std::int32_t bins, double min_length,
              std::int32_t* __restrict bin_of) {
  const FlowVector* const from = vectors.data();
  const double per_image = std::max(1, width);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    // An end that is not finite makes the length not finite.
    const double length = from[i].Length();
    const bool usable = (length >= min_length) & (length <= std::numeric_limits<double>::max());
    const double x = from[i].MidX() / per_image;
    const double least = x > 0 ? x : 0;
    const auto bin = static_cast<std::int32_t>((least < 1 ? least : 1) * bins);
    const std::int32_t within = bin < bins ? bin : bins - 1;
    bin_of[i] = usable ? within : -1;
  }
}

// Smooths with weights 1/4, 1/2, 1/4, so that one bin that is empty by chance makes no valley.
std::vector<double> Smoothed(const std::vector<int>& histogram) {
  const std::size_t last = histogram.size() - 1;
  std::vector<double> result(histogram.size());
  for (std::size_t i = 0; i <= last; ++i) {
    const int low = histogram[i == 0 ? 0 : i - 1];
    const int high = histogram[std::min(last, i + 1)];
    result[i] = 0.25 * (low + 2 * histogram[i] + high);
  }
  return result;
}

// How far each bin lies under the lower of the peaks on its two sides; 0 where it is no valley.
std::vector<double> Depths(const std::vector<double>& histogram, double max_ratio) {
  std::vector<double> depths(histogram.size());
  double right = 0;
  for (std::size_t bin = histogram.size(); bin-- > 0;) {
    depths[bin] = right;
    right = std::max(right, histogram[bin]);
  }
  double left = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    const double lower_peak = std::min(left, depths[bin]);
    left = std::max(left, histogram[bin]);
    depths[bin] = histogram[bin] <= max_ratio * lower_peak ? lower_peak - histogram[bin] : 0;
  }
  return depths;
}

// True if each side of the bin has enough vectors for a landmark.
bool SidesAreLarge(const std::vector<int>& histogram, std::size_t bin,
                   const LandmarkOptions& options) {
  const auto middle = histogram.begin() + static_cast<std::ptrdiff_t>(bin);
  const int left = std::accumulate(histogram.begin(), middle, 0);
  const int right = std::accumulate(middle + 1, histogram.end(), 0);
  const double least = std::max(static_cast<double>(options.min_vectors),
                                options.min_peak_share * (left + right + *middle));
  return std::min(left, right) >= least;
}

// The middle of the lowest bin between the two peaks (Fig. 4); of several equal ones, their middle.
std::optional<double> ValleyOf(const std::vector<int>& histogram, int width,
                               const LandmarkOptions& options) {
  const std::vector<double> depths = Depths(Smoothed(histogram), options.max_valley_ratio);
  double deepest = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t bin = 1; bin + 1 < histogram.size(); ++bin) {
    const double depth = depths[bin];
    if (depth <= 0 || depth < deepest || !SidesAreLarge(histogram, bin, options)) {
      continue;
    }
    if (depth > deepest) {
      first = bin;
      last = bin;
      deepest = depth;
    } else if (bin == last + 1) {
      last = bin;
    }
  }
  if (deepest <= 0) {
    return std::nullopt;
  }
  const double middle = 0.5 * static_cast<double>(first + last) + 0.5;
  return middle * width / static_cast<double>(histogram.size());
}

// The vectors assigned to `landmark`.
SeenLandmark MeanOf(const FlowField& field, const LandmarkSplit& split, int landmark) {
  double x = 0;
  double y = 0;
  double flow_x = 0;
  double flow_y = 0;
  double length = 0;
  double square = 0;
  SeenLandmark seen;
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    if (split.assignment[i] != landmark) {
      continue;
    }
    const FlowVector& v = field.vectors[i];
    const double squared = v.FlowX() * v.FlowX() + v.FlowY() * v.FlowY();
    x += v.MidX();
    y += v.MidY();
    flow_x += v.FlowX();
    flow_y += v.FlowY();
    length += std::sqrt(squared);
    square += squared;
    ++seen.count;
  }
  // Equations (11), (12).
  const auto n = static_cast<double>(std::max(1, seen.count));
  seen.x = static_cast<float>(x / n);
  seen.y = static_cast<float>(y / n);
  seen.flow_x = flow_x / n;
  seen.flow_y = flow_y / n;
  const double mean = length / n;
  seen.spread = mean > 0 ? std::sqrt(std::max(0.0, square / n - mean * mean)) / mean : 0;
  return seen;
}

}  // namespace

LandmarkSplit SplitAtValley(const FlowField& field, const LandmarkOptions& options) {
  LandmarkSplit split;
  split.histogram.assign(static_cast<std::size_t>(options.histogram_bins), 0);
  split.assignment.reserve(field.vectors.size());
  std::vector<std::int32_t> bin_of(field.vectors.size());
  FindBins(field.vectors, field.width, options.histogram_bins, options.min_vector_length_px,
           bin_of.data());
  for (const std::int32_t bin : bin_of) {
    split.assignment.push_back(bin < 0 ? -1 : 0);
    if (bin >= 0) {
      ++split.histogram[static_cast<std::size_t>(bin)];
    }
  }
  split.valley_x = ValleyOf(split.histogram, field.width, options);
  if (!split.valley_x) return split;
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    const bool beyond = field.vectors[i].MidX() >= *split.valley_x;
    split.assignment[i] = split.assignment[i] == 0 && beyond ? 1 : split.assignment[i];
  }
  return split;
}

std::vector<SeenLandmark> FindLandmarks(const FlowField& field, const LandmarkOptions& options) {
  const LandmarkSplit split = SplitAtValley(field, options);
  std::vector<SeenLandmark> seen;
  for (const int landmark : {0, 1}) {
    const SeenLandmark mean = MeanOf(field, split, landmark);
    if (mean.count > 0 && mean.count >= options.min_vectors) {
      seen.push_back(mean);
    }
  }
  return seen;
}

}  // namespace homing
