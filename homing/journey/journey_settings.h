// The settings that shape a journey's stored data. They are stored with it and compared at query
// time.
#ifndef HOMING_JOURNEY_JOURNEY_SETTINGS_H_
#define HOMING_JOURNEY_JOURNEY_SETTINGS_H_

#include <array>
#include <string>

#include "absl/status/status.h"
#include "homing/flow/camera.h"
#include "homing/flow/flow_tracker.h"
#include "homing/landmark/landmark_options.h"
#include "homing/similarity/deviation_model.h"

namespace homing {

struct JourneySettings {
  // Indexed by Side of the route (the outbound robot's left and right camera).
  std::array<Camera, 2> cameras;
  FlowOptions flow;
  LandmarkOptions landmark;
  // Name of the model, "deviationModels/{model}", and its values at creation.
  std::string deviation_model_name = "deviationModels/default";
  DeviationModel deviation_model;
  friend bool operator==(const JourneySettings&, const JourneySettings&) = default;
};

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const JourneySettings& settings);

}  // namespace homing

#endif  // HOMING_JOURNEY_JOURNEY_SETTINGS_H_
