// Figures measured on the map of one journey: how similar its different places are, over how many
// steps its profiles stay similar, and how far the robot moved at each step. They replace constants
// of the filter that would depend on camera, scene or route length.
#ifndef HOMING_PROFILE_ROUTE_SCALE_H_
#define HOMING_PROFILE_ROUTE_SCALE_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "homing/journey/journey_map.h"

namespace homing {

// The direction in which a camera looks, read from the signs of its flow over the journey.
enum class CameraDirection { kUnknown = 0, kAcross = 1, kAlong = 2, kMixed = 3 };

// The odometer of one camera: log2 of the flow that measures motion. Which flow this is depends on
// where the camera looks: the median length across the direction of travel, the spread along it,
// and a weighted mean of both for an oblique camera. Immutable.
class CameraOdometer {
 public:
  // Units of a reading: 1/20 octave.
  static constexpr std::int16_t kPerOctave = 20;
  // No reading.
  static constexpr std::int16_t kNone = INT16_MIN;

  CameraOdometer() = default;
  explicit CameraOdometer(std::span<const FlowProfile> profiles);

  // kNone where the observation has no reading.
  std::int16_t Read(const OdometerReading& reading) const;
  // +1: the camera moves past the scene in the same direction as at recording; -1: in the other
  // direction; 0: unknown.
  int Way(const OdometerReading& reading) const;
  // Logarithm of the odds that the robot drives away from home, by Way and by how steady the sign
  // was over the map. 0: nothing is known.
  double OutwardLogOdds(const OdometerReading& reading) const;
  CameraDirection direction() const { return direction_; }

 private:
  CameraDirection direction_ = CameraDirection::kUnknown;
  // Weight of the median length; the rest is the spread's.
  float length_weight_ = 1;
  // Mean signs over the map, -1 to 1: of the sideways flow, and of the expansion.
  double across_ = 0;
  double along_ = 0;
};

// Length of the stretch over which SharedChange compares, correlation lengths.
inline constexpr double kStretchLengths = 2;

// Figures of one side's profiles. Immutable.
struct SideScale {
  CameraOdometer odometer;
  // By step: its reading, CameraOdometer::kNone without one.
  std::vector<std::int16_t> readings;
  // By step: mean reading of the steps around it.
  std::vector<std::int16_t> usual_readings;
  // By step: half of the difference between its distance to other places and the usual distance. A
  // step that is near to everything would attract every observation.
  std::vector<std::int16_t> bias;
  // Median distances of places one correlation length apart, and kStretchLengths. At least 1.
  float length_distance = 1;
  float stretch_distance = 1;
};

// Immutable.
struct RouteScale {
  // Steps of the map when this was computed.
  std::int64_t step_count = 0;
  // Empty for a side without profiles.
  std::array<std::optional<SideScale>, 2> sides;
  // Lag at which the similarity of neighbours has halved, steps. At least 1.
  double correlation_steps = 1;
  // Deviation of the noise of log2(flow now / flow stored), octaves.
  double odometer_noise = 0;
  // Median fraction of the change over a stretch that the most similar different place shares.
  // Indexed by the compared sides: 1 left, 2 right, 3 both; 0 if the map is too short to measure
  // it.
  std::array<float, 4> different_share{};
};

// By journey. Robots on the same journey share its figures.
using Routes = std::span<const std::shared_ptr<const RouteScale>>;

RouteScale MeasureRoute(const JourneyMap& map);
// The figures of a map that has grown since `measured`: the new steps have no bias and the usual
// reading of the last one.
RouteScale ExtendedRoute(const RouteScale& measured, const JourneyMap& map);

// The same, kept with the map until the map has grown much or has profiles of a new side.
std::shared_ptr<const RouteScale> MeasuredScale(const JourneyMap& map);

}  // namespace homing

#endif  // HOMING_PROFILE_ROUTE_SCALE_H_
