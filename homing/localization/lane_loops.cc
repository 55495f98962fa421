#include "homing/localization/lane_loops.h"

#include "homing/base/vector_clones.h"

namespace homing {

HOMING_VECTOR_CLONES
void MixLanes(const LaneNeighbours& lanes, const LaneMix& mix, std::span<float> out) {
  const auto [same, slower, faster, back, all] = lanes;
  float* const to = out.data();
  for (std::size_t s = 0; s < out.size(); ++s) {
    to[s] = mix.stay * same[s] + mix.from_beside * (slower[s] + faster[s]) +
            mix.from_back * back[s] + mix.from_all * all[s];
  }
}

HOMING_VECTOR_CLONES
void MoveLane(std::span<const float> in, const std::array<float, 4>& taps, float added,
              std::span<float> out) {
  const float* const from = in.data();
  float* const to = out.data();
  for (std::size_t s = 0; s < out.size(); ++s) {
    to[s] = added + taps[0] * from[s] + taps[1] * from[s + 1] + taps[2] * from[s + 2] +
            taps[3] * from[s + 3];
  }
}

HOMING_VECTOR_CLONES
void WeightsOf(std::span<const float> factors, std::span<const std::int16_t> indices,
               const float* table, std::span<float> out) {
  const float* const factor = factors.data();
  const std::int16_t* const index = indices.data();
  float* const to = out.data();
  for (std::size_t s = 0; s < out.size(); ++s) to[s] = factor[s] * table[index[s]];
}

HOMING_VECTOR_CLONES
void WeighLane(std::span<const float> weights, float scale, float least, std::span<float> lane,
               std::span<float> sum) {
  const float* const weight = weights.data();
  float* const value = lane.data();
  float* const total = sum.data();
  for (std::size_t s = 0; s < lane.size(); ++s) {
    const float weighed = value[s] * weight[s] * scale;
    value[s] = weighed < least ? 0 : weighed;
    total[s] += value[s];
  }
}

HOMING_VECTOR_CLONES
void AddLane(std::span<const float> lane, std::span<float> sum) {
  const float* const from = lane.data();
  float* const total = sum.data();
  for (std::size_t s = 0; s < sum.size(); ++s) {
    total[s] += from[s];
  }
}

}  // namespace homing
