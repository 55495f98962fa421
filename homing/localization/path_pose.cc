#include "homing/localization/path_pose.h"

#include <algorithm>
#include <cmath>

#include "homing/flow/vertical_turn.h"
#include "homing/landmark/odometer_reading.h"

namespace homing {
namespace {

// Lengths are in units of the distance of the seen objects.
//
// Standard deviations before the first observation: of the offset, and of the heading, rad.
constexpr double kFirstOffset = 0.15;
constexpr double kFirstHeading = 0.15;
// Growth of the deviations for a unit driven: of the heading, rad, and of the offset. A turn adds a
// share of itself to the heading's.
constexpr double kHeadingDrift = 0.06;
constexpr double kOffsetDrift = 0.05;
constexpr double kTurnError = 0.1;
// Largest turn between two steps, rad: a reading above it is an error.
constexpr double kMostTurn = 0.5;
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

}  // namespace

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

// Motion along the path moves the images of both sides in opposite directions. A turn moves them in
// the same direction, and so does an offset: by the distance driven times the offset.
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
  pose_.heading = knows_heading_ ? pose_.heading + turned : 0;
  heading_variance_ += std::pow(kTurnError * turned, 2);
  // It heads elsewhere: nothing is known of where.
  if (std::abs(pose_.heading) > kMostHeading) {
    Forget();
    knows_heading_ = false;
    pose_.heading = 0;
  }
}

void PathPoseFilter::Forget() {
  is_started_ = false;
  driven_since_lost_ = 0;
  uncorrected_ = kCorrectionSpacing;
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

// A turn to the left moves the image to higher x, in both cameras.
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
  ObservedFlow result;
  result.makes_step = flow.makes_step;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    if (flow.fields[camera]) {
      // The heading is that of the end of the turn.
      result.fields[camera] = Turned(*flow.fields[camera], camera, pose_.heading - turned_);
    }
  }
  return result;
}

}  // namespace homing
