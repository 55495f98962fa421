// The inner loops of RouteBelief over steps. A lane holds the masses of one motion state (direction
// and speed), by step.
#ifndef HOMING_LOCALIZATION_LANE_LOOPS_H_
#define HOMING_LOCALIZATION_LANE_LOOPS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace homing {

// Probabilities of moving by `first`, first + 1, ... steps.
struct Displacement {
  int first = 0;
  std::array<float, 4> probabilities{};
};

// Fractions that a motion state keeps and that it receives from others, an observation.
struct LaneMix {
  float stay = 1;
  float from_beside = 0;
  float from_back = 0;
  float from_all = 0;
};

// out = stay same + from_beside (slower + faster) + from_back back + from_all all. REQUIRES: all as
// long as out.
struct LaneNeighbours {
  const float* same = nullptr;
  const float* slower = nullptr;
  const float* faster = nullptr;
  const float* back = nullptr;
  const float* all = nullptr;
};
void MixLanes(const LaneNeighbours& lanes, const LaneMix& mix, std::span<float> out);

// out[s] = added + sum of taps[i] in[s + i]. REQUIRES: in is three longer than out.
void MoveLane(std::span<const float> in, const std::array<float, 4>& taps, float added,
              std::span<float> out);

// out[s] = factors[s] table[indices[s]]. REQUIRES: all equally long.
void WeightsOf(std::span<const float> factors, std::span<const std::int16_t> indices,
               const float* table, std::span<float> out);

// Multiplies a lane by the weights and by `scale`, and adds it to `sum`. Values below `least`
// become 0. REQUIRES: all equally long.
void WeighLane(std::span<const float> weights, float scale, float least, std::span<float> lane,
               std::span<float> sum);

// sum += lane. REQUIRES: both equally long.
void AddLane(std::span<const float> lane, std::span<float> sum);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_LANE_LOOPS_H_
