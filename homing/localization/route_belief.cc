#include "homing/localization/route_belief.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace homing {
namespace {

constexpr std::size_t kSpeedCount = RouteBelief::kSpeeds.size();
// Probability a step that the speed changes to each neighbour.
constexpr float kSpeedChange = 0.004F;
// Probability a step that the robot turns back.
constexpr float kTurnBack = 0.0003F;
// Probability a step of being one further, or one less far, than the speed says.
constexpr double kDiffusion = 0.05;
// Deviation of the logarithm of the speed relative to the outbound one, before anything was seen.
constexpr double kSpeedDeviation = 0.5;
// Probability a turn on the spot of moving by one either way.
constexpr double kTurnMotion = 0.05;
// Less is nothing: keeps denormal numbers out.
constexpr float kLeastMass = 1e-30F;

// Probabilities of moving by `first`, first + 1, ... steps.
struct Displacement {
  int first = 0;
  std::array<float, 4> probabilities{};
};

// A speed between two whole numbers moves by either so that it is right on average.
Displacement DisplacementOf(double speed) {
  const double whole = std::floor(speed);
  const double part = speed - whole;
  const double q = kDiffusion;
  return {.first = static_cast<int>(whole) - 1,
          .probabilities = {static_cast<float>((1 - part) * q),
                            static_cast<float>((1 - part) * (1 - 2 * q) + part * q),
                            static_cast<float>((1 - part) * q + part * (1 - 2 * q)),
                            static_cast<float>(part * q)}};
}

// Adds `from`, moved by `by` steps, to `to`; what runs off an end is gone.
void AddMoved(const std::vector<float>& from, std::int64_t by, float probability,
              std::vector<float>& to) {
  const std::int64_t n = std::ssize(from);
  const std::int64_t begin = std::clamp<std::int64_t>(-by, 0, n);
  const std::int64_t end = std::clamp<std::int64_t>(n - by, 0, n);
  const float* source = from.data() + begin;
  float* target = to.data() + begin + by;
  for (std::int64_t s = 0; s < end - begin; ++s) {
    target[s] += probability * source[s];
  }
}

void AddMoved(const std::vector<float>& from, const Displacement& displacement, int sign,
              std::vector<float>& to) {
  for (std::size_t i = 0; i < displacement.probabilities.size(); ++i) {
    if (displacement.probabilities[i] > 0) {
      AddMoved(from, sign * (displacement.first + static_cast<int>(i)),
               displacement.probabilities[i], to);
    }
  }
}

// Share of a lane in `mass`: either direction alike, speeds log-normal about the outbound one.
float PriorOf(std::size_t lane, double mass) {
  static const auto weights = [] {
    std::array<double, kSpeedCount> all{};
    for (std::size_t i = 0; i < kSpeedCount; ++i) {
      all[i] = std::exp(-0.5 * std::pow(std::log(RouteBelief::kSpeeds[i]) / kSpeedDeviation, 2));
    }
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    for (double& weight : all) {
      weight /= 2 * sum;
    }
    return all;
  }();
  return static_cast<float>(mass * weights[lane % kSpeedCount]);
}

}  // namespace

void RouteBelief::Grow(std::int64_t step_count, double mass) {
  step_count_ = step_count;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    lanes_[lane].resize(static_cast<std::size_t>(step_count), PriorOf(lane, mass));
  }
}

void RouteBelief::AddToEach(double mass) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const float share = PriorOf(lane, mass);
    for (float& value : lanes_[lane]) {
      value += share;
    }
  }
}

void RouteBelief::MixInto(std::size_t lane, Lane& mixed) const {
  const std::size_t speed = lane % kSpeedCount;
  const bool has_slower = speed > 0;
  const bool has_faster = speed + 1 < kSpeedCount;
  const Lane& same = lanes_[lane];
  const Lane& slower = lanes_[has_slower ? lane - 1 : lane];
  const Lane& faster = lanes_[has_faster ? lane + 1 : lane];
  const Lane& back = lanes_[(lane + kSpeedCount) % kLanes];
  const float stay = 1 - 2 * kSpeedChange - kTurnBack;
  mixed.resize(same.size());
  for (std::size_t s = 0; s < same.size(); ++s) {
    mixed[s] = stay * same[s] + kSpeedChange * (slower[s] + faster[s]) + kTurnBack * back[s];
  }
}

void RouteBelief::Move() {
  for (std::size_t lane = 0; lane < kLanes && step_count_ > 0; ++lane) {
    MixInto(lane, mixed_);
    moved_[lane].assign(mixed_.size(), 0);
    AddMoved(mixed_, DisplacementOf(kSpeeds[lane % kSpeedCount]), lane < kSpeedCount ? -1 : 1,
             moved_[lane]);
  }
  lanes_.swap(moved_);
}

void RouteBelief::Turn() {
  const Displacement displacement{
      .first = -1,
      .probabilities = {static_cast<float>(kTurnMotion), static_cast<float>(1 - 2 * kTurnMotion),
                        static_cast<float>(kTurnMotion), 0}};
  for (std::size_t lane = 0; lane < kLanes && step_count_ > 0; ++lane) {
    moved_[lane].assign(lanes_[lane].size(), 0);
    AddMoved(lanes_[lane], displacement, 1, moved_[lane]);
  }
  lanes_.swap(moved_);
}

void RouteBelief::Weigh(const std::vector<float>& factors) {
  for (Lane& lane : lanes_) {
    for (std::size_t s = 0; s < lane.size(); ++s) {
      const float weighed = lane[s] * factors[s];
      lane[s] = weighed < kLeastMass ? 0 : weighed;
    }
  }
}

void RouteBelief::Scale(double factor) {
  const auto by = static_cast<float>(factor);
  for (Lane& lane : lanes_) {
    for (float& value : lane) {
      value *= by;
    }
  }
}

std::vector<double> RouteBelief::StepMass() const {
  std::vector<double> mass(static_cast<std::size_t>(step_count_));
  for (const Lane& lane : lanes_) {
    for (std::size_t s = 0; s < lane.size(); ++s) {
      mass[s] += double{lane[s]};
    }
  }
  return mass;
}

double RouteBelief::Mass() const {
  const std::vector<double> mass = StepMass();
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}

std::array<double, 2> RouteBelief::DirectionMass(std::int64_t first, std::int64_t last) const {
  std::array<double, 2> mass{};
  for (std::size_t lane = 0; lane < kLanes && step_count_ > 0; ++lane) {
    for (std::int64_t s = first; s <= last; ++s) {
      mass[lane / kSpeedCount] += double{lanes_[lane][static_cast<std::size_t>(s)]};
    }
  }
  return mass;
}

}  // namespace homing
