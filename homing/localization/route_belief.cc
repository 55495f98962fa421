#include "homing/localization/route_belief.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "homing/localization/lane_loops.h"

namespace homing {
namespace {

// Of the changes of speed, those to any speed; the others are to a neighbouring one.
constexpr double kJumpFraction = 0.3;
// Moves that stand for a way that the flow does not show.
constexpr int kUnseenMoves = 4;
// Probability an observation that the robot turns back.
constexpr float kTurnBack = 0.0003F;
// Probability an observation of being one step further, or one less far, than the speed says.
constexpr double kDiffusion = 0.02;
// Probability of moving by one either way in a turn on the spot.
constexpr double kTurnMotion = 0.05;
// Keeps denormal numbers out.
constexpr float kLeastMass = 1e-30F;
// No motion goes further than this, steps.
constexpr std::int64_t kFurthest = 10;

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

constexpr Displacement kTurned{
    .first = -1,
    .probabilities = {static_cast<float>(kTurnMotion), static_cast<float>(1 - 2 * kTurnMotion),
                      static_cast<float>(kTurnMotion), 0}};

// Fraction of a lane in the mass of a step: all directions and speeds alike.
constexpr double kPrior = 1.0 / (2 * kSpeedCount);

}  // namespace

// How lanes change in one step.
struct RouteBelief::Motion {
  LaneMix mix;
  // By speed.
  std::array<Displacement, kSpeedCount> displacements;
};

// The steps that are held afterwards.
struct RouteBelief::Carried {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

void RouteBelief::Grow(std::int64_t step_count, double mass) {
  const bool focused = IsFocused();
  step_count_ = step_count;
  if (focused) {
    return;
  }
  Hold(0, step_count, mass / scale_);
}

void RouteBelief::AddToEach(double mass) {
  background_ += mass / scale_;
  const auto each = static_cast<float>(mass * kPrior / scale_);
  for (float& value : lanes_) value += each;
  for (Lane& way : ways_) {
    for (float& value : way) value += each * kSpeedCount;
  }
}

void RouteBelief::Add(const Place& place) {
  const std::int64_t first = std::max<std::int64_t>(0, place.first);
  const std::int64_t last = std::min(step_count_ - 1, place.last);
  const int ways = (place.homeward ? 1 : 0) + (place.outward ? 1 : 0);
  const double each = place.mass / scale_ / ways / static_cast<double>(last - first + 1);
  const auto add = [first, last](std::span<float> lane, double mass) {
    for (std::int64_t step = first; step <= last; ++step) {
      lane[static_cast<std::size_t>(step)] += static_cast<float>(mass);
    }
  };
  for (std::size_t way = 0; way < ways_.size(); ++way) {
    if (!(way == 0 ? place.homeward : place.outward)) continue;
    add(ways_[way], each);
    for (std::size_t speed = 0; speed < kSpeedCount; ++speed) {
      add(LaneOf(way * kSpeedCount + speed), each / kSpeedCount);
    }
  }
}

void RouteBelief::Hold(std::int64_t first, std::int64_t size, double mass) {
  const std::int64_t begin = std::max(first, first_);
  const std::int64_t end = std::min(first + size, first_ + focus_size());
  const auto held = [&](std::span<const float> before, double fraction, std::span<float> now) {
    std::ranges::fill(now, static_cast<float>(mass * fraction));
    if (begin >= end) return;
    std::copy(before.begin() + (begin - first_), before.begin() + (end - first_),
              now.begin() + (begin - first));
  };
  const auto count = static_cast<std::size_t>(size);
  std::vector<float> lanes(kLanes * count);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    held(LaneOf(lane), kPrior, std::span(lanes).subspan(lane * count, count));
  }
  for (Lane& way : ways_) {
    Lane all(count);
    held(way, kPrior * kSpeedCount, all);
    way = std::move(all);
  }
  lanes_ = std::move(lanes);
  first_ = first;
}

float RouteBelief::Beyond(std::int64_t step) const {
  return step < 0 || step >= step_count_ ? 0 : static_cast<float>(background_ * kPrior);
}

void RouteBelief::Mix(std::size_t lane, const Motion& motion, const Carried& carried,
                      std::span<const float> slower, Lane& mixed) const {
  const std::size_t speed = lane % kSpeedCount;
  const std::int64_t start = carried.begin - kFurthest;
  mixed.resize(static_cast<std::size_t>(carried.end - carried.begin + 2 * kFurthest));
  const std::int64_t held = first_ - start;
  for (std::int64_t i = 0; i < held; ++i) {
    mixed[static_cast<std::size_t>(i)] = Beyond(start + i);
  }
  const std::span<const float> same = LaneOf(lane);
  MixLanes({.same = same.data(),
            .slower = speed > 0 ? slower.data() : same.data(),
            .faster = LaneOf(speed + 1 < kSpeedCount ? lane + 1 : lane).data(),
            .back = LaneOf((lane + kSpeedCount) % kLanes).data(),
            .all = ways_[lane / kSpeedCount].data()},
           motion.mix, std::span(mixed).subspan(static_cast<std::size_t>(held), same.size()));
  for (std::int64_t i = held + std::ssize(same); i < std::ssize(mixed); ++i) {
    mixed[static_cast<std::size_t>(i)] = Beyond(start + i);
  }
}

void RouteBelief::MoveMixed(std::size_t lane, const Motion& motion, double restart,
                            const Lane& mixed, std::span<float> moved) const {
  const Displacement& displacement = motion.displacements[lane % kSpeedCount];
  std::array<float, 4> taps = displacement.probabilities;
  for (float& tap : taps) {
    tap *= static_cast<float>(scale_);
  }
  // What comes to a step: from further away when moving towards home, from nearer to it otherwise.
  std::int64_t from = kFurthest + displacement.first;
  if (lane >= kSpeedCount) {
    std::ranges::reverse(taps);
    from = kFurthest - displacement.first - 3;
  }
  MoveLane(std::span(mixed).subspan(static_cast<std::size_t>(from)), taps,
           static_cast<float>(restart * kPrior), moved);
}

// Speed by speed, both directions at once, because a lane needs the one of the speed before as it
// was. A window that keeps its size is changed in place: that reads and writes less memory than a
// copy of all lanes.
void RouteBelief::Carry(const Motion& motion, double restart) {
  if (focus_size() == 0) {
    AddToEach(restart);
    return;
  }
  const Carried carried{.begin = std::max<std::int64_t>(0, first_ - kFurthest),
                        .end = std::min(step_count_, first_ + focus_size() + kFurthest)};
  const auto size = static_cast<std::size_t>(carried.end - carried.begin);
  std::vector<float> wider(size == ways_[0].size() ? 0 : kLanes * size);
  const std::span<float> moved = wider.empty() ? std::span(lanes_) : std::span(wider);
  std::array<Lane, 2> slower, mixed, ways;
  for (std::size_t way = 0; way < ways.size(); ++way) {
    slower[way].resize(ways_[0].size());
    ways[way].resize(size);
  }
  for (std::size_t speed = 0; speed < kSpeedCount; ++speed) {
    const std::array lanes = {speed, speed + kSpeedCount};
    for (std::size_t way = 0; way < lanes.size(); ++way) {
      Mix(lanes[way], motion, carried, slower[way], mixed[way]);
    }
    for (std::size_t way = 0; way < lanes.size(); ++way) {
      std::ranges::copy(LaneOf(lanes[way]), slower[way].begin());
      const std::span<float> to = moved.subspan(lanes[way] * size, size);
      MoveMixed(lanes[way], motion, restart, mixed[way], to);
      AddLane(to, ways[way]);
    }
  }
  if (!wider.empty()) lanes_ = std::move(wider);
  ways_ = std::move(ways);
  first_ = carried.begin;
  background_ = background_ * scale_ + restart;
  scale_ = 1;
}

double RouteBelief::Move(double change, double restart) {
  return MoveMixing(change * (1 - kJumpFraction), change * kJumpFraction, restart);
}

double RouteBelief::MoveUnseen(double restart) {
  double left = 1;
  for (int i = 0; i < kUnseenMoves; ++i)
    left *= 1 - MoveMixing(0, 1 - kTurnBack, i == 0 ? restart : 0);
  return 1 - left;
}

double RouteBelief::MoveMixing(double to_neighbours, double to_any, double restart) {
  const double beside = 0.5 * to_neighbours;
  const double all = to_any / kSpeedCount;
  Motion motion{.mix = {.stay = static_cast<float>(1 - to_neighbours - to_any - kTurnBack),
                        .from_beside = static_cast<float>(beside),
                        .from_back = kTurnBack,
                        .from_all = static_cast<float>(all)},
                .displacements = {}};
  std::ranges::transform(kSpeeds, motion.displacements.begin(), DisplacementOf);
  const double before = MassWithin();
  Carry(motion, restart);
  const double after = MassWithin() - restart * static_cast<double>(focus_size());
  return before > 0 ? std::clamp(1 - after / before, 0.0, 1.0) : 0;
}

void RouteBelief::Turn(double restart) {
  static const Motion motion = [] {
    Motion all;
    all.displacements.fill(kTurned);
    return all;
  }();
  Carry(motion, restart);
}

StepMass RouteBelief::Weigh(std::span<const float> factors, std::span<const std::int16_t> ratios,
                            const SpeedEvidence& speeds, const std::array<double, 2>& directions) {
  double mass = 0;
  Speed sum;
  Lane weights(factors.size());
  for (Lane& way : ways_) std::ranges::fill(way, 0.0F);
  for (std::size_t speed = 0; speed < kSpeedCount; ++speed) {
    WeightsOf(factors, ratios, speeds.of(speed), weights);
    for (std::size_t way = 0; way < ways_.size(); ++way) {
      const std::span<float> lane = LaneOf(way * kSpeedCount + speed);
      WeighLane(weights, static_cast<float>(scale_ * directions[way]), kLeastMass, lane,
                ways_[way]);
      const double of_lane = SumOf(lane);
      mass += of_lane;
      sum.absolute += of_lane * kSpeeds[speed];
      sum.outward += of_lane * (way == 0 ? -kSpeeds[speed] : kSpeeds[speed]);
    }
  }
  mean_speed_ = mass > 0 ? Speed{sum.absolute / mass, sum.outward / mass} : Speed{};
  background_ *= scale_;
  scale_ = 1;
  return Masses();
}

void RouteBelief::Scale(double factor) { scale_ *= factor; }

void RouteBelief::Focus(double least, const StepMass& mass) {
  const auto enough = [least](float value) { return double{value} >= least; };
  const auto begin = std::ranges::find_if(mass.mass, enough);
  const auto end =
      std::find_if(mass.mass.rbegin(), std::make_reverse_iterator(begin), enough).base();
  const auto skipped = begin - mass.mass.begin();
  const auto kept = end - begin;
  if (!IsFocused() && kept < std::ssize(mass.mass)) {
    const double beyond =
        std::accumulate(mass.mass.begin(), begin, 0.0) + std::accumulate(end, mass.mass.end(), 0.0);
    background_ = beyond / (scale_ * static_cast<double>(step_count_ - kept));
  }
  if (kept < std::ssize(mass.mass)) Hold(first_ + skipped, kept, 0);
}

void RouteBelief::Unfocus() {
  if (!IsFocused()) {
    return;
  }
  Hold(0, step_count_, background_);
}

}  // namespace homing
