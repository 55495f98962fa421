#include "client/simulator/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "client/simulator/seeded_random.h"
#include "client/simulator/simulator.h"

namespace homing::client {
namespace {

constexpr std::size_t kNoiseCount = 65536;
constexpr std::uint64_t kNoiseSeed = 1729;

// Standard normal numbers (Box and Muller 1958), scaled to mean 0 and deviation 1 exactly.
std::array<float, kNoiseCount> MakeNoise() {
  SeededRandom random(kNoiseSeed);
  std::vector<double> values;
  while (values.size() < kNoiseCount) {
    const double radius = std::sqrt(-2 * std::log(1 - random.Uniform(0, 1)));
    const double angle = random.Uniform(0, 2 * std::numbers::pi);
    values.push_back(radius * std::cos(angle));
    values.push_back(radius * std::sin(angle));
  }
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const double mean = sum / kNoiseCount;
  const double deviation = std::sqrt(squares / kNoiseCount - mean * mean);
  std::array<float, kNoiseCount> noise{};
  for (std::size_t i = 0; i < kNoiseCount; ++i) {
    noise[i] = static_cast<float>((values[i] - mean) / deviation);
  }
  return noise;
}

std::uint64_t FrameKey(std::uint64_t seed, std::int64_t frame, Side camera) {
  return Mix(seed, static_cast<std::uint64_t>(frame), static_cast<std::uint64_t>(camera) + 1);
}

}  // namespace

double Sensor::Gain(std::int64_t frame, Side camera) const {
  SeededRandom random(~FrameKey(drive_seed, frame, camera));
  return light * random.Uniform(1 - kExposureVariation, 1 + kExposureVariation);
}

cv::Mat Sensor::Expose(const std::vector<float>& brightness, std::int64_t frame,
                       Side camera) const {
  static const std::array<float, kNoiseCount> standard_noise = MakeNoise();
  const auto gain = static_cast<float>(Gain(frame, camera));
  const auto sigma = static_cast<float>(noise);
  const std::uint64_t key = FrameKey(drive_seed, frame, camera);
  cv::Mat image(Simulator::kHeight, Simulator::kWidth, CV_8UC1);
  std::uint8_t* out = image.ptr<std::uint8_t>();
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < brightness.size(); ++i) {
    // Four numbers of 16 bits to a mixed counter.
    bits = i % 4 == 0 ? Mix(key + i) : bits >> 16U;
    const float value = gain * brightness[i] + sigma * standard_noise[bits % kNoiseCount];
    // Adds half a level, so that the conversion rounds to nearest.
    const float raised = value + 0.5F;
    out[i] = static_cast<std::uint8_t>(std::clamp(raised, 0.0F, 255.0F));
  }
  return image;
}

}  // namespace homing::client
