#include "homing/profile/route_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "homing/flow/median.h"
#include "homing/profile/different_share.h"
#include "homing/profile/profile_distance.h"
#include "homing/profile/profile_evidence.h"

namespace homing {
namespace {

// Stored profiles that are compared with all others.
constexpr std::int64_t kSelfSamples = 256;
constexpr std::int64_t kMostLag = 200;
// Fraction of a step's bias that is subtracted. Subtracting all of it would also remove what
// distinguishes the step.
constexpr double kBiasPart = 0.5;
// A map is measured again when it has grown by this factor.
constexpr double kMuchGrown = 1.25;
// Neighbours whose readings are averaged.
constexpr double kReadingSteps = 3;
// The sign of one kind of flow must be steadier than that of the other by this much.
constexpr double kClearDirection = 0.2;
// A sign that never changed over the map may still change now.
constexpr double kSurestSign = 0.95;
// Deviation of normal noise over the median of its absolute second difference.
const double kDeviationOfRoughness = 1 / (0.6745 * std::sqrt(6.0));

double MedianOf(std::vector<float>& values) {
  return double{Median(std::span<const float>(values))};
}

int SignOf(int value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// Mean sign of the readings' values, -1 to 1.
template <typename Value>
double MeanSign(std::span<const FlowProfile> profiles, Value value) {
  double sum = 0, count = 0;
  for (const FlowProfile& profile : profiles) {
    if (!profile.odometer.has_value()) continue;
    sum += SignOf(value(profile.odometer));
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

// Median absolute second difference of the readings, codes.
template <typename Value>
double Roughness(std::span<const FlowProfile> profiles, Value value) {
  std::vector<float> rough;
  for (std::size_t i = 2; i < profiles.size(); ++i) {
    const OdometerReading& a = profiles[i - 2].odometer;
    const OdometerReading& b = profiles[i - 1].odometer;
    const OdometerReading& c = profiles[i].odometer;
    if (!a.has_value() || !b.has_value() || !c.has_value()) continue;
    rough.push_back(static_cast<float>(std::abs(value(a) - 2 * value(b) + value(c))));
  }
  return MedianOf(rough);
}

int LengthOf(const OdometerReading& reading) { return reading.length_code; }
int SpreadOf(const OdometerReading& reading) { return reading.spread_code; }

// Adds the readings of the profiles that have none yet.
void AddReadings(std::span<const FlowProfile> profiles, SideScale& side) {
  for (const FlowProfile& profile : profiles.subspan(side.readings.size())) {
    side.readings.push_back(side.odometer.Read(profile.odometer));
  }
}

// Mean over the neighbours, weighted by a Gaussian of kReadingSteps steps; where none has a
// reading, the median of all.
std::vector<std::int16_t> UsualReadings(std::span<const std::int16_t> readings) {
  std::vector<float> valid;
  for (const std::int16_t reading : readings) {
    if (reading != CameraOdometer::kNone) valid.push_back(reading);
  }
  std::vector<std::int16_t> usual(readings.size(),
                                  static_cast<std::int16_t>(std::lround(MedianOf(valid))));
  const auto reach = static_cast<std::int64_t>(3 * kReadingSteps);
  for (std::int64_t step = 0; step < std::ssize(usual); ++step) {
    double sum = 0, weights = 0;
    for (std::int64_t other = std::max<std::int64_t>(0, step - reach);
         other <= std::min(step + reach, std::ssize(usual) - 1); ++other) {
      const std::int16_t reading = readings[static_cast<std::size_t>(other)];
      if (reading == CameraOdometer::kNone) continue;
      const double apart = static_cast<double>(other - step) / kReadingSteps;
      const double weight = std::exp(-0.5 * apart * apart);
      sum += weight * reading;
      weights += weight;
    }
    if (weights > 0) {
      usual[static_cast<std::size_t>(step)] = static_cast<std::int16_t>(std::lround(sum / weights));
    }
  }
  return usual;
}

// Distances of sampled profiles of one side to all of its stored ones.
struct SelfDistances {
  // Steps of the sampled profiles.
  std::vector<std::int64_t> at;
  // By sampled profile, then by step.
  std::vector<std::vector<std::uint16_t>> distances;
};

SelfDistances MeasureSelf(std::span<const FlowProfile> stored) {
  SelfDistances self;
  const std::int64_t stride = std::max<std::int64_t>(1, std::ssize(stored) / kSelfSamples);
  for (std::int64_t step = 0; step < std::ssize(stored); step += stride) {
    if (!(stored[static_cast<std::size_t>(step)] == FlowProfile{})) self.at.push_back(step);
  }
  const CellMask all = CoveredCells(1);
  self.distances.resize(self.at.size(), std::vector<std::uint16_t>(stored.size()));
  std::vector<ProfileView> views;
  for (std::size_t i = 0; i < self.at.size(); ++i) {
    views.push_back({stored[static_cast<std::size_t>(self.at[i])], all, self.distances[i]});
  }
  ProfileDistances(views, stored);
  return self;
}

std::vector<std::int16_t> BiasOf(const SelfDistances& self, std::size_t steps) {
  std::vector<float> middles(steps);
  std::vector<std::uint16_t> column(self.at.size());
  for (std::size_t step = 0; step < steps; ++step) {
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = self.distances[i][step];
    middles[step] = static_cast<float>(Median(std::span<const std::uint16_t>(column)));
  }
  const float usual = Median(std::span<const float>(middles));
  std::vector<std::int16_t> bias(steps);
  for (std::size_t step = 0; step < steps; ++step) {
    bias[step] = static_cast<std::int16_t>(std::lround(kBiasPart * double{middles[step] - usual}));
  }
  return bias;
}

void TakeOff(std::span<const std::int16_t> bias, SelfDistances& self) {
  for (auto& row : self.distances) {
    for (std::size_t step = 0; step < row.size(); ++step) {
      row[step] = static_cast<std::uint16_t>(std::max(0, row[step] - bias[step]));
    }
  }
}

// The lag at which the mean deviation from different places is half of that at lag 1.
double CorrelationOf(const SelfDistances& self, std::int64_t steps) {
  std::vector<DistanceScale> scales;
  for (const auto& row : self.distances) scales.push_back(ScaleOf(row));
  double first = 0, before = 0;
  for (std::int64_t lag = 1; lag < std::min(kMostLag, std::max<std::int64_t>(2, steps / 2));
       ++lag) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < self.at.size(); ++i) {
      for (const std::int64_t other : {self.at[i] - lag, self.at[i] + lag}) {
        if (other < 0 || other >= steps) continue;
        sum += double{scales[i].Deviations(self.distances[i][static_cast<std::size_t>(other)])};
        count += 1;
      }
    }
    const double mean = count > 0 ? sum / count : 0;
    if (lag == 1) {
      first = mean;
    } else if (mean > 0.5 * first) {
      return static_cast<double>(lag) - 1 +
             std::clamp((0.5 * first - before) / (mean - before), 0.0, 1.0);
    }
    before = mean;
  }
  return std::clamp<double>(static_cast<double>(steps) / 2, 1, static_cast<double>(kMostLag));
}

// Median distance of places `lag` apart; of all pairs on a map that is shorter.
float DistanceAt(const SelfDistances& self, std::int64_t lag) {
  std::vector<float> at_lag, all;
  for (std::size_t i = 0; i < self.at.size(); ++i) {
    for (std::int64_t step = 0; step < std::ssize(self.distances[i]); ++step) {
      const auto distance = static_cast<float>(self.distances[i][static_cast<std::size_t>(step)]);
      const std::int64_t apart = std::abs(step - self.at[i]);
      if (apart == lag) at_lag.push_back(distance);
      if (apart > 0) all.push_back(distance);
    }
  }
  return std::max(1.0F, static_cast<float>(MedianOf(at_lag.empty() ? all : at_lag)));
}

}  // namespace

CameraOdometer::CameraOdometer(std::span<const FlowProfile> profiles) {
  across_ = MeanSign(profiles, [](const auto& r) { return int{r.median_x}; });
  along_ = MeanSign(profiles, [](const auto& r) { return int{r.expansion}; });
  const double across = std::abs(across_), along = std::abs(along_);
  if (across == 0 && along == 0) {
    return;
  }
  if (across >= along + kClearDirection) {
    direction_ = CameraDirection::kAcross;
  } else if (along >= across + kClearDirection) {
    direction_ = CameraDirection::kAlong;
    length_weight_ = 0;
  } else {
    direction_ = CameraDirection::kMixed;
    const double length = std::pow(std::max(1.0, Roughness(profiles, LengthOf)), 2);
    const double spread = std::pow(std::max(1.0, Roughness(profiles, SpreadOf)), 2);
    length_weight_ = static_cast<float>(spread / (length + spread));
  }
}

int CameraOdometer::Way(const OdometerReading& reading) const {
  return std::abs(across_) >= std::abs(along_) ? SignOf(reading.median_x) * (across_ < 0 ? -1 : 1)
                                               : SignOf(reading.expansion) * (along_ < 0 ? -1 : 1);
}

double CameraOdometer::OutwardLogOdds(const OdometerReading& reading) const {
  const double steadiness = std::max(std::abs(across_), std::abs(along_));
  const double right = std::min(kSurestSign, 0.5 * (1 + steadiness));
  return Way(reading) * std::log(right / (1 - right));
}

std::int16_t CameraOdometer::Read(const OdometerReading& reading) const {
  if (!reading.has_value()) {
    return kNone;
  }
  return static_cast<std::int16_t>(
      std::lround(length_weight_ * static_cast<float>(reading.length_code) +
                  (1 - length_weight_) * static_cast<float>(reading.spread_code)));
}

RouteScale MeasureRoute(const JourneyMap& map) {
  RouteScale route;
  route.step_count = map.step_count();
  std::array<SelfDistances, 2> selves;
  std::vector<double> lengths, noises;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto stored = map.profiles(side);
    if (stored.empty()) continue;
    const auto at = static_cast<std::size_t>(side);
    SideScale& scale = route.sides[at].emplace();
    scale.odometer = CameraOdometer(stored);
    AddReadings(stored, scale);
    scale.usual_readings = UsualReadings(scale.readings);
    selves[at] = MeasureSelf(stored);
    scale.bias = BiasOf(selves[at], stored.size());
    TakeOff(scale.bias, selves[at]);
    lengths.push_back(CorrelationOf(selves[at], map.step_count()));
    const auto read = [&scale](const OdometerReading& r) { return int{scale.odometer.Read(r)}; };
    noises.push_back(Roughness(stored, read) * kDeviationOfRoughness / CameraOdometer::kPerOctave);
  }
  if (lengths.empty()) {
    return route;
  }
  route.correlation_steps = std::max(1.0, *std::ranges::min_element(lengths));
  // The map's noise and that of the robot now, which has the same cameras; two cameras average.
  route.odometer_noise = *std::ranges::max_element(noises) * std::numbers::sqrt2 /
                         std::sqrt(static_cast<double>(noises.size()));
  const auto steps_of = [&route](double count) {
    return static_cast<std::int64_t>(std::lround(count * route.correlation_steps));
  };
  for (std::size_t at = 0; at < selves.size(); ++at) {
    if (!route.sides[at]) continue;
    route.sides[at]->length_distance = DistanceAt(selves[at], steps_of(1));
    route.sides[at]->stretch_distance = DistanceAt(selves[at], steps_of(kStretchLengths));
  }
  MeasureDifferentShare(map, route);
  return route;
}

RouteScale ExtendedRoute(const RouteScale& measured, const JourneyMap& map) {
  RouteScale route = measured;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    std::optional<SideScale>& scale = route.sides[static_cast<std::size_t>(side)];
    if (!scale) continue;
    const auto stored = map.profiles(side);
    AddReadings(stored, *scale);
    scale->bias.resize(stored.size());
    scale->usual_readings.resize(stored.size(), scale->usual_readings.back());
  }
  return route;
}

std::shared_ptr<const RouteScale> MeasuredScale(const JourneyMap& map) {
  std::shared_ptr<const RouteScale> kept = map.measured_route().get();
  const auto is_new = [&](std::size_t side) {
    return !map.profiles(Side{static_cast<int>(side)}).empty() && !kept->sides[side];
  };
  if (!kept || is_new(0) || is_new(1) ||
      static_cast<double>(map.step_count()) > kMuchGrown * static_cast<double>(kept->step_count)) {
    kept = std::make_shared<const RouteScale>(MeasureRoute(map));
    map.measured_route().set(kept);
  }
  return kept;
}

}  // namespace homing
