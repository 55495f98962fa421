#include "tests/accuracy/picture_peers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "homing/localization/route_belief.h"
#include "homing/localization/step_window.h"

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

Answers PictureFilter(const Run& run, const Differences& differences, double slope) {
  const auto map = StepsOf(*run.maps[0]);
  const auto places = static_cast<std::int64_t>(map.size());
  RouteBelief belief;
  const SpeedEvidence speeds(1);
  belief.Grow(places, 1.0 / static_cast<double>(places));
  Answers answers;
  for (const std::vector<float>& row : differences) {
    std::vector<float> sorted = row;
    std::ranges::sort(sorted);
    const double middle = sorted[sorted.size() / 2];
    double squares = 0;
    for (const float value : sorted) squares += std::pow(std::max(0.0, value - middle), 2);
    const double deviation =
        std::sqrt(squares / (0.5 * static_cast<double>(sorted.size()))) + 1e-3 * middle + 1e-9;
    std::vector<float> factors;
    for (const float value : row) {
      factors.push_back(static_cast<float>(
          std::exp(std::clamp(-slope * (value - middle) / deviation, -5.0, 5.0))));
    }
    belief.Move(0.05);
    belief.Scale(1 / std::max(belief.Mass(), 1e-20));
    belief.AddToEach(5e-4 / static_cast<double>(places));
    belief.Weigh(factors, std::vector<std::int16_t>(factors.size(), SpeedEvidence::kNoRatio),
                 speeds);
    belief.Scale(1 / std::max(belief.Mass(), 1e-20));
    const StepWindow window = BestWindow(belief.Masses(), run.tolerance_steps, places);
    answers.push_back(
        {.place = map[static_cast<std::size_t>(window.step)]->place, .score = window.mass});
  }
  return run.ByInstant(answers);
}

}  // namespace homing::accuracy
