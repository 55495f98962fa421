// The correction of the pose: the images against the map, from poses around the believed one.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "homing/landmark/flow_profile.h"
#include "homing/localization/path_pose.h"
#include "homing/profile/profile_distance.h"

namespace homing {
namespace {

// The belief never gets surer than this.
constexpr double kLeastOffset = 0.03;
constexpr double kLeastHeading = 0.015;
// Poses tried: so many either way, a deviation apart within these bounds.
constexpr int kTries = 2;
constexpr double kLeastOffsetStep = 0.06, kMostOffsetStep = 0.15;
constexpr double kLeastHeadingStep = 0.04, kMostHeadingStep = 0.12;
// Steps tried either way.
constexpr std::int64_t kSteps = 10;
// Log likelihood of a unit of profile distance.
constexpr double kPerDistance = 1.0 / 60;
// A motion below this, or below this share of the turn, shows no depth. The first offset is
// reported after kDrivenAtStart.
constexpr double kLeastDriven = 0.003;
constexpr double kLeastOfTurn = 0.15;
constexpr double kDrivenAtStart = 0.2;

// Of the cells.
double ShareOf(const CellMask& covered) {
  return static_cast<double>(std::ranges::count(covered, 255)) / FlowProfile::kCells;
}

}  // namespace

struct PathPoseFilter::Tried {
  static constexpr int kCount = 2 * kTries + 1;
  std::array<double, kCount> offsets{};
  std::array<double, kCount> headings{};
  // By heading and offset: minus the log prior, and the distances of both sides to each step.
  std::array<std::array<double, kCount>, kCount> surprises{};
  std::array<std::array<std::array<double, 2 * kSteps + 1>, kCount>, kCount> sums{};
  // The least of them.
  std::array<std::array<double, kCount>, kCount> distances{};
};

void PathPoseFilter::Correct(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow) {
  if (std::abs(driven_) < std::max(kLeastDriven, kLeastOfTurn * std::abs(turned_))) return;
  uncorrected_ += std::abs(driven_);
  driven_since_lost_ += std::abs(driven_);
  if (uncorrected_ < kCorrectionSpacing) return;
  uncorrected_ = 0;
  Tried tried = PosesToTry();
  const std::int64_t first = std::max<std::int64_t>(0, step - kSteps);
  const std::int64_t end = std::min(map.step_count(), step + kSteps + 1);
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto stored =
        map.profiles(RouteSide(camera, travel_))
            .subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
    Compare(stored, *flow.fields[At(camera)], camera, tried);
  }
  for (std::size_t h = 0; h < tried.headings.size(); ++h) {
    for (std::size_t o = 0; o < tried.offsets.size(); ++o) {
      const auto of_steps =
          std::span(tried.sums[h][o]).first(static_cast<std::size_t>(end - first));
      tried.distances[h][o] = *std::ranges::min_element(of_steps);
    }
  }
  Fit(tried);
}

PathPoseFilter::Tried PathPoseFilter::PosesToTry() const {
  Tried tried;
  const double offset_step =
      std::clamp(std::sqrt(offset_variance_), kLeastOffsetStep, kMostOffsetStep);
  const double heading_step =
      std::clamp(std::sqrt(heading_variance_), kLeastHeadingStep, kMostHeadingStep);
  for (int i = 0; i < Tried::kCount; ++i) {
    const auto at = static_cast<std::size_t>(i);
    tried.offsets[at] =
        std::clamp(pose_.offset + (i - kTries) * offset_step, -kMostOffset, kMostOffset);
    tried.headings[at] = pose_.heading + (i - kTries) * heading_step;
  }
  const double determinant =
      std::max(1e-12, offset_variance_ * heading_variance_ - covariance_ * covariance_);
  for (std::size_t h = 0; h < tried.headings.size(); ++h) {
    for (std::size_t o = 0; o < tried.offsets.size(); ++o) {
      const double of = tried.offsets[o] - pose_.offset, he = tried.headings[h] - pose_.heading;
      tried.surprises[h][o] =
          0.5 *
          (of * of * heading_variance_ - 2 * of * he * covariance_ + he * he * offset_variance_) /
          determinant;
    }
  }
  return tried;
}

// All poses at once: each stored profile is read once.
void PathPoseFilter::Compare(std::span<const FlowProfile> stored, const FlowField& field,
                             Side camera, Tried& tried) const {
  constexpr std::size_t kPoses = std::size_t{Tried::kCount} * Tried::kCount;
  std::array<CellMask, Tried::kCount> covered;
  std::array<FlowProfile, kPoses> profiles;
  std::vector<std::uint16_t> distances(kPoses * stored.size());
  std::vector<ProfileView> views;
  views.reserve(kPoses);
  for (const double heading : tried.headings) {
    const ProfileMaker seen(Turned(field, At(camera), heading - turned_), OdometerReading{});
    for (std::size_t o = 0; o < tried.offsets.size(); ++o) {
      const double nearer = camera == Side::kLeft ? tried.offsets[o] : -tried.offsets[o];
      if (views.size() == o) covered[o] = CoveredCells(1 - nearer);
      FlowProfile& profile = profiles[views.size()];
      profile = seen.Make(1 - nearer);
      views.push_back({profile, covered[o],
                       std::span(distances).subspan(views.size() * stored.size(), stored.size())});
    }
  }
  ProfileDistances(views, stored);
  for (std::size_t pose = 0; pose < kPoses; ++pose) {
    const double share = ShareOf(views[pose].covered);
    auto& sums = tried.sums[pose / Tried::kCount][pose % Tried::kCount];
    for (std::size_t i = 0; i < stored.size(); ++i) sums[i] += views[pose].distances[i] / share;
  }
}

void PathPoseFilter::Fit(const Tried& tried) {
  double least = tried.distances[0][0];
  for (const auto& row : tried.distances) least = std::min(least, *std::ranges::min_element(row));
  double sum = 0, mean_o = 0, mean_h = 0, oo = 0, hh = 0, oh = 0;
  for (std::size_t h = 0; h < tried.headings.size(); ++h) {
    for (std::size_t o = 0; o < tried.offsets.size(); ++o) {
      const double of = tried.offsets[o] - pose_.offset, he = tried.headings[h] - pose_.heading;
      const double weight =
          std::exp(-tried.surprises[h][o] - kPerDistance * (tried.distances[h][o] - least));
      sum += weight;
      mean_o += weight * of;
      mean_h += weight * he;
      oo += weight * of * of;
      hh += weight * he * he;
      oh += weight * of * he;
    }
  }
  if (!(sum > 1e-300) || !std::isfinite(sum)) return;
  mean_o /= sum;
  mean_h /= sum;
  pose_.offset += mean_o;
  pose_.heading = std::clamp(pose_.heading + mean_h, -kMostHeading, kMostHeading);
  offset_variance_ = std::max(oo / sum - mean_o * mean_o, kLeastOffset * kLeastOffset);
  heading_variance_ = std::max(hh / sum - mean_h * mean_h, kLeastHeading * kLeastHeading);
  const double most = 0.9 * std::sqrt(offset_variance_ * heading_variance_);
  covariance_ = std::clamp(oh / sum - mean_o * mean_h, -most, most);
  is_started_ = is_started_ || driven_since_lost_ > kDrivenAtStart;
  knows_heading_ = knows_heading_ || is_started_;
}

}  // namespace homing
