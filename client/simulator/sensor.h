// Brightness to image: exposure and noise.
#ifndef CLIENT_SIMULATOR_SENSOR_H_
#define CLIENT_SIMULATOR_SENSOR_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "homing/flow/observation.h"

namespace homing::client {

struct Sensor {
  // Gain before its variation by kExposureVariation.
  double light = 1;
  // Grey levels.
  double noise = 2;
  // Seed of noise and exposure.
  std::uint64_t drive_seed = 1;

  // Each frame of each camera has its own gain in light * [1 - this, 1 + this].
  static constexpr double kExposureVariation = 0.1;

  double Gain(std::int64_t frame, Side camera) const;
  // CV_8UC1, from brightness row by row.
  cv::Mat Expose(const std::vector<float>& brightness, std::int64_t frame, Side camera) const;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SENSOR_H_
