#include "homing/localization/path_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "homing/flow/vertical_turn.h"
#include "homing/landmark/flow_profile.h"
#include "homing/landmark/odometer_reading.h"
#include "homing/profile/profile_distance.h"

namespace homing {
namespace {

// Lengths are in units of the distance of the seen objects, as METHOD 7 has them.
//
// Deviations before anything was seen: of the offset, and of the heading, rad.
constexpr double kFirstOffset = 0.15;
constexpr double kFirstHeading = 0.15;
// Growth of the deviations for a unit driven: of the heading, rad, and of the offset. A turn adds a
// share of itself to the heading's.
constexpr double kHeadingDrift = 0.06;
constexpr double kOffsetDrift = 0.05;
constexpr double kTurnError = 0.1;
// The belief never gets surer than this.
constexpr double kLeastOffset = 0.03;
constexpr double kLeastHeading = 0.015;
// Poses tried: so many either way, a deviation apart within these bounds.
constexpr int kTries = 2;
constexpr double kLeastOffsetStep = 0.06, kMostOffsetStep = 0.15;
constexpr double kLeastHeadingStep = 0.04, kMostHeadingStep = 0.12;
constexpr double kMostOffset = 0.6;
constexpr double kMostHeading = 0.8;
// Largest turn between two steps, rad: a reading above it is an error.
constexpr double kMostTurn = 0.5;
// A pose with a prior below e^-6 of the best is not compared.
constexpr double kMostSurprise = 6;
// Steps tried either way.
constexpr std::int64_t kSteps = 10;
// Log likelihood of a unit of profile distance. The pose is corrected each time that the robot has
// driven kCorrectionSpacing: views nearer to each other repeat the same evidence.
constexpr double kPerDistance = 1.0 / 60;
constexpr double kCorrectionSpacing = 0.10;
// A motion below this, or below this share of the turn, shows no depth. The first offset is
// reported after kDrivenAtStart.
constexpr double kLeastDriven = 0.003;
constexpr double kLeastOfTurn = 0.15;
constexpr double kDrivenAtStart = 0.06;
// Error of a turn that is read against the map: rad, and rad for a unit driven.
constexpr double kMapTurn = 0.002;
constexpr double kMapTurnError = 0.1;
// The same where the path's bend is known, so that the vertical flow alone shows the turn: what has
// gone from one side puts its share of the flow into the turn that is read against the map.
constexpr double kChangedMapTurnError = 0.5;
// Deviation of a turn that nothing shows, rad an observation.
constexpr double kUnseenTurn = 0.03;
// Opposite sideways flows that differ by less say nothing of the motion, pixels.
constexpr double kLeastAdvancePx = 1;

std::size_t At(Side side) { return static_cast<std::size_t>(side); }

// Of the cells.
double ShareOf(const CellMask& covered) {
  return static_cast<double>(std::ranges::count(covered, 255)) / FlowProfile::kCells;
}

}  // namespace

struct PathPoseFilter::Tried {
  static constexpr int kCount = 2 * kTries + 1;
  std::array<double, kCount> offsets{};
  std::array<double, kCount> headings{};
  // By heading and offset: minus the log prior, and the least distance over the steps; infinite
  // where the pose is not compared.
  std::array<std::array<double, kCount>, kCount> surprises{};
  std::array<std::array<double, kCount>, kCount> distances{};
};

PathPoseFilter::PathPoseFilter(Travel travel, const std::array<Camera, 2>& cameras)
    : travel_(travel),
      cameras_(cameras),
      offset_variance_(kFirstOffset * kFirstOffset),
      heading_variance_(kFirstHeading * kFirstHeading) {}

void PathPoseFilter::StartAtOffset(double offset) { pose_.offset = offset; }

PathPose PathPoseFilter::deviation() const {
  return {std::sqrt(offset_variance_), std::sqrt(heading_variance_)};
}

double PathPoseFilter::FocalOf(std::size_t camera, int width) const {
  const auto& intrinsics = cameras_[camera].intrinsics;
  return intrinsics ? intrinsics->focal_x : UsualFocal(width);
}

// METHOD 7: the motion along the path moves the images of both sides against each other, a turn
// moves them alike, and so does an offset: by the distance driven times the offset.
bool PathPoseFilter::Predict(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow) {
  turned_ = 0;
  driven_ = 0;
  std::array<double, 2> now{}, then{};
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto& field = flow.fields[At(camera)];
    const Side side = RouteSide(camera, travel_);
    const auto stored = map.profiles(side);
    if (!field || stored.empty()) return false;
    const std::optional<std::int16_t> seen = ReadMedianX(*field);
    const OdometerReading& of_step = stored[static_cast<std::size_t>(step)].odometer;
    if (!seen || !of_step.has_value()) return false;
    const double per_focal =
        1 / (OdometerReading::kSignedPerPx * FocalOf(At(camera), field->width));
    now[At(side)] = *seen * per_focal;
    then[At(side)] = of_step.median_x * per_focal;
  }
  const double advance = then[1] - then[0];
  const double focal = FocalOf(0, flow.fields[0]->width);
  if (std::abs(advance) * focal < kLeastAdvancePx) return false;
  const VerticalTurn vertical = ReadVerticalTurn(flow, cameras_);
  const std::optional<double> bend = StoredBend(map, step);
  const Advance moved = AdvanceOf(now, then, vertical.turn, bend);
  driven_ = 0.5 * moved.steps * advance * (travel_ == Travel::kReturn ? -1 : 1);
  const double by_vertical = vertical.turn - moved.steps * moved.bend;
  // A turn that is read against the map alone.
  const double ratio = (now[1] - now[0]) / advance;
  const double by_map =
      0.5 * (now[0] + now[1] - ratio * (then[0] + then[1])) + driven_ * pose_.offset;
  const double map_error = bend ? kChangedMapTurnError : kMapTurnError;
  const double map_variance = kMapTurn * kMapTurn + std::pow(map_error * driven_, 2);
  const double share = map_variance / (map_variance + vertical.variance);
  turned_ = by_map + share * (by_vertical - by_map);
  if (!std::isfinite(turned_) || std::abs(turned_) > kMostTurn || !std::isfinite(driven_)) {
    turned_ = 0;
    driven_ = 0;
    return false;
  }
  pose_.heading = std::clamp(pose_.heading + turned_, -kMostHeading, kMostHeading);
  pose_.offset = std::clamp(pose_.offset + driven_ * pose_.heading, -kMostOffset, kMostOffset);
  // The heading takes up the offset's error, and the offset the heading's.
  const double d = driven_;
  const double offset = offset_variance_ + 2 * d * covariance_ + d * d * heading_variance_;
  const double heading = heading_variance_ + 2 * d * covariance_ + d * d * offset_variance_;
  covariance_ += d * (offset_variance_ + heading_variance_);
  offset_variance_ = offset + kOffsetDrift * kOffsetDrift * std::abs(d);
  heading_variance_ =
      heading + kHeadingDrift * kHeadingDrift * std::abs(d) + std::pow(kTurnError * turned_, 2);
  has_motion_ = true;
  return true;
}

void PathPoseFilter::Turn(double turned) {
  pose_.heading = is_started_ ? pose_.heading + turned : 0;
  heading_variance_ += std::pow(kTurnError * turned, 2);
  // It heads elsewhere: nothing is known of where.
  if (std::abs(pose_.heading) > kMostHeading) {
    Forget();
    pose_.heading = 0;
  }
}

void PathPoseFilter::Forget() {
  is_started_ = false;
  driven_since_lost_ = 0;
  advance_.reset();
  pose_.offset = 0;
  offset_variance_ = kFirstOffset * kFirstOffset;
  heading_variance_ = kFirstHeading * kFirstHeading;
  covariance_ = 0;
}

bool PathPoseFilter::TurnAlone(const ObservedFlow& flow) {
  const VerticalTurn vertical = ReadVerticalTurn(flow, cameras_);
  heading_variance_ += std::min(vertical.variance, kUnseenTurn * kUnseenTurn);
  if (!(vertical.variance < kUnseenTurn * kUnseenTurn)) return false;
  pose_.heading = std::clamp(pose_.heading + vertical.turn, -kMostHeading, kMostHeading);
  return true;
}

// A turn to the left moves what is seen to higher x, in both cameras.
FlowField PathPoseFilter::Turned(const FlowField& field, std::size_t camera, double heading) const {
  const auto focal = static_cast<float>(FocalOf(camera, field.width));
  const auto& intrinsics = cameras_[camera].intrinsics;
  const auto center_x =
      static_cast<float>(intrinsics ? intrinsics->center_x : 0.5 * (field.width - 1));
  const auto center_y =
      static_cast<float>(intrinsics ? intrinsics->center_y : 0.5 * (field.height - 1));
  const auto turn = [&](float& x, float& y, float c, float s) {
    const float ray = (x - center_x) / focal;
    const float per_depth = 1 / std::max(0.1F, c + s * ray);
    x = center_x + focal * (c * ray - s) * per_depth;
    y = center_y + (y - center_y) * per_depth;
  };
  FlowField result = field;
  const auto cosine = [](double angle) { return static_cast<float>(std::cos(angle)); };
  const auto sine = [](double angle) { return static_cast<float>(std::sin(angle)); };
  const float c = cosine(heading), s = sine(heading);
  const float end_c = cosine(heading + turned_), end_s = sine(heading + turned_);
  for (FlowVector& v : result.vectors) {
    turn(v.start_x, v.start_y, c, s);
    turn(v.end_x, v.end_y, end_c, end_s);
  }
  return result;
}

ObservedFlow PathPoseFilter::Straighten(const ObservedFlow& flow) const {
  ObservedFlow result = flow;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    if (result.fields[camera]) {
      // The heading is that of the end of the turn.
      result.fields[camera] = Turned(*result.fields[camera], camera, pose_.heading - turned_);
    }
  }
  return result;
}

void PathPoseFilter::Correct(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow) {
  if (std::abs(driven_) < std::max(kLeastDriven, kLeastOfTurn * std::abs(turned_))) return;
  uncorrected_ += std::abs(driven_);
  if (uncorrected_ < kCorrectionSpacing) return;
  uncorrected_ = 0;
  Tried tried = PosesToTry();
  const std::int64_t first = std::max<std::int64_t>(0, step - kSteps);
  const std::int64_t end = std::min(map.step_count(), step + kSteps + 1);
  for (std::size_t h = 0; h < tried.headings.size(); ++h) {
    CompareAtHeading(map, first, end, flow, h, tried);
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

void PathPoseFilter::CompareAtHeading(const JourneyMap& map, std::int64_t first, std::int64_t end,
                                      const ObservedFlow& flow, std::size_t heading,
                                      Tried& tried) const {
  std::vector<std::size_t> offsets;
  tried.distances[heading].fill(std::numeric_limits<double>::infinity());
  for (std::size_t o = 0; o < tried.offsets.size(); ++o) {
    if (tried.surprises[heading][o] <= kMostSurprise) offsets.push_back(o);
  }
  if (offsets.empty()) return;
  const auto steps = static_cast<std::size_t>(end - first);
  std::vector<std::uint16_t> distances(steps);
  std::array<std::vector<double>, Tried::kCount> sums;
  for (auto& sum : sums) sum.assign(steps, 0);
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto stored =
        map.profiles(RouteSide(camera, travel_)).subspan(static_cast<std::size_t>(first), steps);
    const ProfileMaker seen(
        Turned(*flow.fields[At(camera)], At(camera), tried.headings[heading] - turned_),
        OdometerReading{});
    for (const std::size_t o : offsets) {
      const double nearer = camera == Side::kLeft ? tried.offsets[o] : -tried.offsets[o];
      const FlowProfile profile = seen.Make(1 - nearer);
      const CellMask covered = CoveredCells(1 - nearer);
      ProfileDistances(profile, stored, covered, distances);
      const double share = ShareOf(covered);
      for (std::size_t i = 0; i < steps; ++i) sums[o][i] += distances[i] / share;
    }
  }
  for (const std::size_t o : offsets) {
    tried.distances[heading][o] = *std::ranges::min_element(sums[o]);
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
  driven_since_lost_ += std::abs(driven_);
  is_started_ = is_started_ || driven_since_lost_ > kDrivenAtStart;
}

}  // namespace homing
