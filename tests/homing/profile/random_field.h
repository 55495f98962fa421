// Flow fields for tests of profiles.
#ifndef TESTS_HOMING_PROFILE_RANDOM_FIELD_H_
#define TESTS_HOMING_PROFILE_RANDOM_FIELD_H_

#include <random>

#include "homing/flow/flow_vector.h"

namespace homing {

// A camera's field of `count` vectors at random places, about the middle of the image.
inline FlowField RandomField(std::mt19937_64& engine, int count = 120) {
  std::uniform_real_distribution<float> x(60, 260);
  std::uniform_real_distribution<float> y(40, 200);
  std::uniform_real_distribution<float> length(2, 6);
  FlowField field{.width = 320, .height = 240, .vectors = {}};
  for (int i = 0; i < count; ++i) {
    const float at = x(engine);
    const float height = y(engine);
    const float half = length(engine) / 2;
    field.vectors.push_back({at - half, height, at + half, height});
  }
  return field;
}

// As seen from nearer, about the middle of the image.
inline FlowField Nearer(FlowField field, float by) {
  for (FlowVector& v : field.vectors) {
    v = {159.5F + by * (v.start_x - 159.5F), 119.5F + by * (v.start_y - 119.5F),
         159.5F + by * (v.end_x - 159.5F), 119.5F + by * (v.end_y - 119.5F)};
  }
  return field;
}

}  // namespace homing

#endif  // TESTS_HOMING_PROFILE_RANDOM_FIELD_H_
