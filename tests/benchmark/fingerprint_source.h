// Fingerprints of many journeys, made up.
#ifndef TESTS_BENCHMARK_FINGERPRINT_SOURCE_H_
#define TESTS_BENCHMARK_FINGERPRINT_SOURCE_H_

#include <cstdint>
#include <random>
#include <string>

#include "homing/journey/journey_map.h"

namespace homing::benchmarks {

inline constexpr int kStepsPerJourney = 1000;
inline constexpr int kStepsPerLandmark = 10;
inline constexpr float kImageWidth = 640;
inline constexpr float kImageHeight = 480;

// kUniform: means anywhere in the image, 1 to 200 vectors. kCity: landmarks drift across the image
// from step to step, near the horizon, and most have about 60 vectors.
enum class Layout { kUniform, kCity };

Layout LayoutOf(const std::string& name);

// One fingerprint a step, without end. Same seed, same fingerprints.
class FingerprintSource {
 public:
  FingerprintSource(Layout layout, std::uint32_t seed) : layout_(layout), random_(seed) {}
  // Of step `step` of a journey.
  Fingerprint Next(std::int64_t step);

 private:
  float Uniform(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }

  const Layout layout_;
  std::mt19937 random_;
  // The landmark that is passed (city).
  float y_ = 0;
  float count_ = 0;
  float offset_ = 0;
};

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_FINGERPRINT_SOURCE_H_
