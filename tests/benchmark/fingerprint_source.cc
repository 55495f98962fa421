#include "tests/benchmark/fingerprint_source.h"

#include <algorithm>
#include <cmath>

namespace homing::benchmarks {

Layout LayoutOf(const std::string& name) {
  return name == "city" ? Layout::kCity : Layout::kUniform;
}

Fingerprint FingerprintSource::Next(std::int64_t step) {
  const auto landmark = static_cast<std::int32_t>(step / kStepsPerLandmark);
  if (layout_ == Layout::kUniform) {
    return {Uniform(0, kImageWidth), Uniform(0, kImageHeight),
            std::uniform_int_distribution<std::int32_t>(1, 200)(random_), landmark};
  }
  const auto at = static_cast<float>(step % kStepsPerLandmark);
  if (at == 0 || count_ == 0) {
    y_ = std::normal_distribution<float>(0.45F * kImageHeight, 40)(random_);
    count_ = std::exp(std::normal_distribution<float>(4.1F, 0.5F)(random_));
    offset_ = Uniform(0, kImageWidth / kStepsPerLandmark);
  }
  const float x = offset_ + at * kImageWidth / kStepsPerLandmark + Uniform(-4, 4);
  const float count = count_ * Uniform(0.9F, 1.1F);
  return {std::clamp(x, 0.0F, kImageWidth), std::clamp(y_ + Uniform(-3, 3), 0.0F, kImageHeight),
          std::max(1, static_cast<std::int32_t>(count)), landmark};
}

}  // namespace homing::benchmarks
