// Converts cameras and journey settings between messages and homing types.
#ifndef PROTO_WIRE_SETTINGS_CONVERSION_H_
#define PROTO_WIRE_SETTINGS_CONVERSION_H_

#include <string>

#include "absl/status/statusor.h"
#include "homing/flow/camera.h"
#include "homing/journey/journey_settings.h"
#include "homing/v1/types.pb.h"

namespace homing::wire {

// All FromProto: INVALID_ARGUMENT naming the field (under the path `field`), its value and the
// limit.

absl::StatusOr<Camera> FromProto(const v1::Camera& message, const std::string& field);
absl::StatusOr<FlowOptions> FromProto(const v1::FlowSettings& message, const std::string& field);
absl::StatusOr<LandmarkOptions> FromProto(const v1::LandmarkSettings& message,
                                          const std::string& field);
// Unset parts have the values of `defaults`: flow, landmark and cameras as a whole, and the name of
// the deviation model. The model's values are those of `defaults`: the caller looks them up.
absl::StatusOr<JourneySettings> FromProto(const v1::JourneySettings& message,
                                          const std::string& field,
                                          const JourneySettings& defaults);

v1::Camera ToProto(const Camera& camera);
v1::FlowSettings ToProto(const FlowOptions& options);
v1::LandmarkSettings ToProto(const LandmarkOptions& options);
v1::JourneySettings ToProto(const JourneySettings& settings);

// `Message` is v1::DeviationModel or v1::DeviationValues.
template <typename Message>
void FillDeviation(const DeviationModel& model, Message* message) {
  message->set_mu(model.mu);
  message->set_sigma(model.sigma);
  message->set_observations(model.observations);
  message->set_ks_distance(model.ks_distance);
  message->set_width(model.width);
  message->set_height(model.height);
}

// The reverse of FillDeviation; checks nothing.
template <typename Message>
DeviationModel DeviationOf(const Message& message) {
  DeviationModel model;
  model.mu = message.mu();
  model.sigma = message.sigma();
  model.observations = message.observations();
  model.ks_distance = message.ks_distance();
  model.width = message.width();
  model.height = message.height();
  return model;
}

}  // namespace homing::wire

#endif  // PROTO_WIRE_SETTINGS_CONVERSION_H_
