// The class Texture of texture_pool.h.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "client/simulator/texture_pool.h"

namespace homing::client {
namespace {

std::vector<double> Halved(const std::vector<double>& tones, std::size_t side) {
  std::vector<double> result;
  result.reserve(tones.size() / 4);
  for (std::size_t y = 0; y < side; y += 2) {
    for (std::size_t x = 0; x < side; x += 2) {
      const std::size_t i = y * side + x;
      result.push_back(0.25 * (tones[i] + tones[i + 1] + tones[i + side] + tones[i + side + 1]));
    }
  }
  return result;
}

std::vector<std::int8_t> Packed(const std::vector<double>& tones) {
  std::vector<std::int8_t> result;
  result.reserve(tones.size());
  for (const double tone : tones) {
    result.push_back(static_cast<std::int8_t>(std::lround(127 * std::clamp(tone, -1.0, 1.0))));
  }
  return result;
}

}  // namespace

Texture::Texture(const std::vector<double>& tones) {
  std::vector<double> current = tones;
  for (int side = kSide; side >= 1; side /= 2) {
    levels_.push_back({side, Packed(current)});
    if (side > 1) {
      current = Halved(current, static_cast<std::size_t>(side));
    }
  }
}

float Texture::SampleLevel(const Level& level, float u, float v) {
  const auto side = static_cast<float>(level.side);
  // Adds one texel, so that the conversion rounds down at u = 0 too.
  const float x = u * side + 0.5F;
  const float y = v * side + 0.5F;
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int mask = level.side - 1;
  const int x0 = (left - 1) & mask;
  const int x1 = left & mask;
  const std::int8_t* row0 = level.tones.data() + ((top - 1) & mask) * level.side;
  const std::int8_t* row1 = level.tones.data() + (top & mask) * level.side;
  const float a = x - static_cast<float>(left);
  const float b = y - static_cast<float>(top);
  const float above = (1 - a) * static_cast<float>(row0[x0]) + a * static_cast<float>(row0[x1]);
  const float below = (1 - a) * static_cast<float>(row1[x0]) + a * static_cast<float>(row1[x1]);
  return ((1 - b) * above + b * below) * (1.0F / 127.0F);
}

float Texture::Sample(float u, float v, float level) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const float bounded = std::clamp(level, 0.0F, last);
  const auto fine = static_cast<std::size_t>(bounded);
  const float share = bounded - static_cast<float>(fine);
  const float tone = SampleLevel(levels_[fine], u, v);
  if (share <= 0) {
    return tone;
  }
  return (1 - share) * tone + share * SampleLevel(levels_[fine + 1], u, v);
}

}  // namespace homing::client
