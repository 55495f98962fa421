#include "tests/accuracy/picture_peers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "homing/localization/direction_evidence.h"
#include "homing/localization/distance_moved.h"
#include "homing/localization/route_belief.h"
#include "homing/localization/speed_ratios.h"
#include "homing/localization/step_window.h"
#include "homing/profile/profile_evidence.h"
#include "tests/accuracy/homing_runs.h"

namespace homing::accuracy {
namespace {

constexpr int kPatch = 8;
// Of SeqSLAM's enhancement and of the second-best line.
constexpr int kNeighbourhood = 10;

using Normalised = std::vector<float>;

Normalised Normalise(const Picture& picture) {
  Normalised result(picture.size());
  if (picture.empty()) return result;
  for (int top = 0; top < kPictureHeight; top += kPatch) {
    for (int left = 0; left < kPictureWidth; left += kPatch) {
      double sum = 0;
      double squares = 0;
      const auto each = [&](auto&& what) {
        for (int y = top; y < top + kPatch; ++y) {
          for (int x = left; x < left + kPatch; ++x) {
            what(static_cast<std::size_t>(y * kPictureWidth + x));
          }
        }
      };
      each([&](std::size_t at) {
        sum += picture[at];
        squares += double{static_cast<double>(picture[at])} * picture[at];
      });
      const double mean = sum / (kPatch * kPatch);
      const double deviation =
          std::sqrt(std::max(0.0, squares / (kPatch * kPatch) - mean * mean)) + 1e-3;
      each([&](std::size_t at) {
        result[at] = static_cast<float>((picture[at] - mean) / deviation);
      });
    }
  }
  return result;
}

float Difference(const Normalised& a, const Normalised& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<float>(a.size());
}

// Of each row: value - mean, over deviation, among the neighbours along the route.
Differences Enhance(const Differences& differences) {
  Differences result = differences;
  for (std::size_t q = 0; q < differences.size(); ++q) {
    const auto& row = differences[q];
    for (std::ptrdiff_t m = 0; m < std::ssize(row); ++m) {
      const auto first = std::max<std::ptrdiff_t>(0, m - kNeighbourhood / 2);
      const auto last = std::min<std::ptrdiff_t>(std::ssize(row), m + kNeighbourhood / 2 + 1);
      double sum = 0;
      double squares = 0;
      for (auto i = first; i < last; ++i) {
        const double value = row[static_cast<std::size_t>(i)];
        sum += value;
        squares += value * value;
      }
      const auto count = static_cast<double>(last - first);
      const double mean = sum / count;
      const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean)) + 1e-6;
      result[q][static_cast<std::size_t>(m)] =
          static_cast<float>((row[static_cast<std::size_t>(m)] - mean) / deviation);
    }
  }
  return result;
}

// A difference of 1 as a distance.
constexpr float kPerDifference = 8192;
// Probability a step of having been set down there; that of PositionOptions.
constexpr double kRestart = 1e-4;

class PictureBelief {
 public:
  // Keeps the map.
  PictureBelief(const JourneyMap& map, std::shared_ptr<const RouteScale> route)
      : map_(map), route_(std::move(route)), speeds_(route_->odometer_noise), unbiased_(Steps()) {
    belief_.Grow(map.step_count(), 1.0 / static_cast<double>(map.step_count()));
  }

  StepWindow Update(const ObservedFlow& flow, const Run& run, std::span<const float> differences) {
    SeenProfiles profiles;
    for (std::size_t camera = 0; camera < 2; ++camera) {
      const auto side = RouteSide(Side{static_cast<int>(camera)}, run.travel);
      if (flow.fields[camera]) {
        profiles[static_cast<std::size_t>(side)].emplace(*flow.fields[camera]);
      }
    }
    if (started_) {
      belief_.Move(speeds_.change(), kRestart / static_cast<double>(Steps()));
      belief_.Scale(1 / std::max(belief_.Mass(), 1e-20));
    }
    const StepMass masses = belief_.Masses();
    const double moved = distance_.Update({&route_, 1}, {&masses, 1}, profiles).value_or(1);
    const double weight = started_ ? EvidenceWeight(moved, route_->correlation_steps) : 1;
    started_ = true;
    belief_.Weigh(FactorsOf(differences, weight), SpeedRatios(*route_, masses, profiles), speeds_,
                  DirectionFactors(*route_, profiles, weight));
    belief_.Scale(1 / std::max(belief_.Mass(), 1e-20));
    return BestWindow(belief_.Masses(), run.tolerance_steps, map_.step_count());
  }

 private:
  std::size_t Steps() const { return static_cast<std::size_t>(map_.step_count()); }

  std::vector<float> FactorsOf(std::span<const float> differences, double weight) const {
    std::vector<std::uint16_t> distances;
    for (const float difference : differences) {
      distances.push_back(
          static_cast<std::uint16_t>(std::min(difference * kPerDifference, 65535.0F)));
    }
    std::vector<float> factors(distances.size(), 1);
    ProfileRatio::OfWeight(weight).Multiply(distances, unbiased_, ScaleOf(distances), factors);
    return factors;
  }

  const JourneyMap& map_;
  std::shared_ptr<const RouteScale> route_;
  SpeedEvidence speeds_;
  std::vector<std::int16_t> unbiased_;
  RouteBelief belief_;
  DistanceMoved distance_;
  bool started_ = false;
};

}  // namespace

Differences DifferencesOf(const Run& run) {
  const auto map = StepsOf(*run.maps[0]);
  const auto query = run.QuerySteps();
  Differences differences(query.size(), std::vector<float>(map.size(), 0));
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const auto side =
        static_cast<std::size_t>(RouteSide(Side{static_cast<int>(camera)}, run.travel));
    std::vector<Normalised> stored;
    for (const Instant* step : map) stored.push_back(Normalise(step->pictures[side]));
    for (std::size_t q = 0; q < query.size(); ++q) {
      const Normalised seen = Normalise(query[q]->pictures[camera]);
      for (std::size_t m = 0; m < map.size(); ++m) {
        if (!seen.empty() && !stored[m].empty()) differences[q][m] += Difference(seen, stored[m]);
      }
    }
  }
  return differences;
}

Answers SeqSlam(const Run& run, const Differences& differences, int window) {
  const Differences enhanced = Enhance(differences);
  const auto map = StepsOf(*run.maps[0]);
  const auto places = static_cast<int>(map.size());
  Answers answers;
  for (std::size_t q = 0; q < enhanced.size(); ++q) {
    const int length = std::min(window, static_cast<int>(q) + 1);
    std::vector<double> best(static_cast<std::size_t>(places), 1e9);
    for (int end = 0; end < places; ++end) {
      for (double speed = -2; speed <= 2.01; speed += 0.1) {
        if (std::abs(speed) < 0.49) continue;
        double sum = 0;
        for (int back = 0; back < length; ++back) {
          const int place =
              std::clamp(static_cast<int>(std::lround(end - speed * back)), 0, places - 1);
          sum += enhanced[q - static_cast<std::size_t>(back)][static_cast<std::size_t>(place)];
        }
        auto& value = best[static_cast<std::size_t>(end)];
        value = std::min(value, sum / length);
      }
    }
    const auto found = static_cast<int>(std::ranges::min_element(best) - best.begin());
    double second = 1e9;
    for (int place = 0; place < places; ++place) {
      if (std::abs(place - found) >= kNeighbourhood) {
        second = std::min(second, best[static_cast<std::size_t>(place)]);
      }
    }
    const double lead = second < 1e9 ? second - best[static_cast<std::size_t>(found)]
                                     : -best[static_cast<std::size_t>(found)];
    answers.push_back({.place = map[static_cast<std::size_t>(found)]->place, .score = lead});
  }
  return run.ByInstant(answers);
}

Answers PictureFilter(const Run& run, const Differences& differences) {
  const JourneyMap map = MapOf(*run.maps[0]);
  const auto route = std::make_shared<const RouteScale>(MeasureRoute(map));
  const auto steps = StepsOf(*run.maps[0]);
  const auto query = run.QuerySteps();
  PictureBelief belief(map, route);
  Answers answers;
  for (std::size_t q = 0; q < query.size(); ++q) {
    const StepWindow window = belief.Update(query[q]->flow, run, differences[q]);
    answers.push_back(
        {.place = steps[static_cast<std::size_t>(window.step)]->place, .score = window.mass});
  }
  return run.ByInstant(answers);
}

}  // namespace homing::accuracy
