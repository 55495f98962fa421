// A synthetic route of landmarks for tests of the localisation: the view from any place of it, as
// noisy fingerprints. Deterministic.
#ifndef TESTS_SUPPORT_LANDMARK_WORLD_H_
#define TESTS_SUPPORT_LANDMARK_WORLD_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "homing/journey/journey_map.h"
#include "homing/matching/matcher.h"

namespace homing {

class LandmarkWorld {
 public:
  // Half the width of a camera's view, steps of the outbound journey.
  static constexpr double kHalfView = 8;

  LandmarkWorld(std::uint64_t seed, int steps) : steps_(steps), engine_(seed) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      for (double at = -kHalfView; at < steps + kHalfView; at += Uniform(5, 12)) {
        posts_.push_back({side, at, Uniform(50, 190), std::exp(Uniform(3, 5.3))});
      }
    }
  }

  // Takes away about this share of the landmarks.
  void Remove(double share) {
    std::erase_if(posts_, [&](const Post&) { return Uniform(0, 1) < share; });
  }

  // The view at `at` steps from home; noisy, at most two landmarks a side, low x first.
  SeenSides See(double at) {
    SeenSides seen;
    for (const Post& post : posts_) {
      std::vector<SeenLandmark>& side = seen[static_cast<std::size_t>(post.side)];
      const double ahead = (post.at - at) / kHalfView;
      if (std::abs(ahead) < 1 && side.size() < 2) {
        SeenLandmark landmark;
        landmark.x = static_cast<float>(160 + 140 * ahead + 4 * Noise());
        landmark.y = static_cast<float>(post.y + 4 * Noise());
        landmark.count = static_cast<int>(std::ceil(post.count * std::exp(0.15 * Noise())));
        side.push_back(landmark);
      }
    }
    for (std::vector<SeenLandmark>& side : seen) {
      std::sort(side.begin(), side.end(),
                [](const SeenLandmark& a, const SeenLandmark& b) { return a.x < b.x; });
    }
    return seen;
  }

  // The outbound journey, up to `steps`.
  JourneyMap Record(int steps) {
    JourneyMap map;
    for (int step = 0; step < steps; ++step) {
      Append(map);
    }
    return map;
  }
  JourneyMap Record() { return Record(steps_); }

  // The next step of the outbound journey. Every fingerprint is its own landmark.
  void Append(JourneyMap& map) {
    JourneyStep step;
    step.step = map.step_count();
    const SeenSides seen = See(static_cast<double>(step.step));
    for (const Side side : {Side::kLeft, Side::kRight}) {
      for (const SeenLandmark& landmark : seen[static_cast<std::size_t>(side)]) {
        const auto number =
            static_cast<std::int32_t>(map.landmarks().size() + step.fingerprints.size());
        step.fingerprints.push_back({side, {landmark.x, landmark.y, landmark.count, number}, 0.0});
      }
    }
    const absl::Status status = map.Append(step);
    if (!status.ok()) {
      std::abort();
    }
  }

  int steps() const { return steps_; }

 private:
  struct Post {
    Side side;
    // Steps from home.
    double at;
    double y;
    double count;
  };

  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }
  // Nearly normal, deviation 1.
  double Noise() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) {
      sum += Uniform(0, 1);
    }
    return sum;
  }

  int steps_;
  std::mt19937_64 engine_;
  std::vector<Post> posts_;
};

}  // namespace homing

#endif  // TESTS_SUPPORT_LANDMARK_WORLD_H_
