// Deviation models in messages; the declarations are in message_conversion.h.
#include "proto/wire/observation_conversion.h"
#include "proto/wire/settings_conversion.h"
#include "server/service/message_conversion.h"

namespace homing::server {
namespace {

v1::TrainingSettings EncodeTraining(const TrainingOptions& options) {
  v1::TrainingSettings message;
  message.set_width(options.width);
  message.set_height(options.height);
  message.set_focal_px(options.focal_px);
  message.set_observations(options.observations);
  message.set_seed(options.seed);
  message.set_velocity_mean_kmh(options.velocity_mean_kmh);
  message.set_velocity_deviation_kmh(options.velocity_deviation_kmh);
  message.set_distance_mean_m(options.distance_mean_m);
  message.set_distance_deviation_m(options.distance_deviation_m);
  message.set_lateral_offset_m(options.lateral_offset_m);
  message.set_vertical_offset_m(options.vertical_offset_m);
  message.set_elapsed_s(options.elapsed_s);
  message.set_frame_interval_s(options.frame_interval_s);
  return message;
}

// `value` if it is set, else the previous value.
template <typename T>
void Take(bool given, T value, T* target) {
  if (given) {
    *target = value;
  }
}

}  // namespace

v1::DeviationModel EncodeModel(const storage::StoredModel& model) {
  v1::DeviationModel message;
  message.set_name(model.name);
  wire::FillDeviation(model.model, &message);
  // The built-in model was not trained here.
  if (model.create_time_ns != 0) {
    *message.mutable_settings() = EncodeTraining(model.training);
    *message.mutable_create_time() = wire::TimestampToProto(model.create_time_ns);
  }
  return message;
}

TrainingOptions DecodeTraining(const v1::TrainingSettings& s) {
  TrainingOptions options;
  Take(s.width() != 0, s.width(), &options.width);
  Take(s.height() != 0, s.height(), &options.height);
  Take(s.has_focal_px(), s.focal_px(), &options.focal_px);
  Take(s.has_observations(), s.observations(), &options.observations);
  Take(s.has_seed(), static_cast<std::uint64_t>(s.seed()), &options.seed);
  Take(s.has_velocity_mean_kmh(), s.velocity_mean_kmh(), &options.velocity_mean_kmh);
  Take(s.has_velocity_deviation_kmh(), s.velocity_deviation_kmh(), &options.velocity_deviation_kmh);
  Take(s.has_distance_mean_m(), s.distance_mean_m(), &options.distance_mean_m);
  Take(s.has_distance_deviation_m(), s.distance_deviation_m(), &options.distance_deviation_m);
  Take(s.has_lateral_offset_m(), s.lateral_offset_m(), &options.lateral_offset_m);
  Take(s.has_vertical_offset_m(), s.vertical_offset_m(), &options.vertical_offset_m);
  Take(s.has_elapsed_s(), s.elapsed_s(), &options.elapsed_s);
  Take(s.has_frame_interval_s(), s.frame_interval_s(), &options.frame_interval_s);
  return options;
}

}  // namespace homing::server
