#include "storage/settings_json.h"

#include <nlohmann/json.hpp>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace homing {

// Names and fields of each struct, for writing and reading; a missing field is an error.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Intrinsics, focal_x, focal_y, center_x, center_y)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FlowOptions, working_width_px, smoothing_sigma_px,
                                   normalization_window_px, normalization_floor, min_eigenvalue,
                                   cell_px, window_px, pyramid_levels, max_forward_backward_px)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LandmarkOptions, min_vector_length_px, min_vectors,
                                   histogram_bins, max_valley_ratio, min_peak_share,
                                   max_track_distance_px, max_track_gap_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviationModel, mu, sigma, observations, ks_distance, width,
                                   height)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrainingOptions, width, height, focal_px, observations, seed,
                                   velocity_mean_kmh, velocity_deviation_kmh, distance_mean_m,
                                   distance_deviation_m, lateral_offset_m, vertical_offset_m,
                                   elapsed_s, frame_interval_s)

}  // namespace homing

namespace homing::storage {
namespace {

using Json = nlohmann::json;

// Five values unless the lens has more, so that the text of older settings stays the same.
Json DistortionToJson(const Camera& camera) {
  std::vector<double> values(camera.distortion.begin(), camera.distortion.end());
  if (values[5] == 0 && values[6] == 0 && values[7] == 0) values.resize(5);
  return values;
}

void DistortionFromJson(const Json& json, Camera& camera) {
  const auto values = json.get<std::vector<double>>();
  if (values.size() > camera.distortion.size()) {
    throw Json::other_error::create(501, "distortion has too many values", &json);
  }
  std::copy(values.begin(), values.end(), camera.distortion.begin());
}

Json CameraToJson(const Camera& camera) {
  Json json = {{"width", camera.width},
               {"height", camera.height},
               {"distortion", DistortionToJson(camera)},
               {"yaw_rad", camera.yaw_rad}};
  // Written only if true, so that the text of other cameras stays the same.
  if (camera.fisheye) json["fisheye"] = true;
  if (camera.intrinsics) json["intrinsics"] = *camera.intrinsics;
  return json;
}

void CameraFromJson(const Json& json, Camera& camera) {
  json.at("width").get_to(camera.width);
  json.at("height").get_to(camera.height);
  DistortionFromJson(json.at("distortion"), camera);
  camera.fisheye = json.value("fisheye", false);
  json.at("yaw_rad").get_to(camera.yaw_rad);
  if (json.contains("intrinsics")) {
    json["intrinsics"].get_to(camera.intrinsics.emplace());
  }
}

// `read` may throw Json::exception.
template <typename Result, typename Read>
absl::StatusOr<Result> Parse(const std::string& text, const char* what, Read read) {
  try {
    Result result;
    read(Json::parse(text), result);
    return result;
  } catch (const Json::exception& exception) {
    return absl::DataLossError(
        absl::StrCat("store: ", what, " are not JSON of the expected form: ", exception.what()));
  }
}

}  // namespace

std::string ToJson(const JourneySettings& settings) {
  const Json json = {{"left_camera", CameraToJson(settings.cameras[0])},
                     {"right_camera", CameraToJson(settings.cameras[1])},
                     {"flow", settings.flow},
                     {"landmark", settings.landmark},
                     {"deviation_model_name", settings.deviation_model_name},
                     {"deviation_model", settings.deviation_model}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const TrainingOptions& options) { return Json(options).dump(); }

std::string ToJson(const std::vector<std::string>& names) {
  return Json(names).dump(-1, ' ', false, Json::error_handler_t::replace);
}

absl::StatusOr<JourneySettings> JourneySettingsFromJson(const std::string& text) {
  return Parse<JourneySettings>(
      text, "settings of a journey", [](const Json& json, JourneySettings& settings) {
        CameraFromJson(json.at("left_camera"), settings.cameras[0]);
        CameraFromJson(json.at("right_camera"), settings.cameras[1]);
        json.at("flow").get_to(settings.flow);
        json.at("landmark").get_to(settings.landmark);
        json.at("deviation_model_name").get_to(settings.deviation_model_name);
        json.at("deviation_model").get_to(settings.deviation_model);
      });
}

absl::StatusOr<TrainingOptions> TrainingOptionsFromJson(const std::string& text) {
  return Parse<TrainingOptions>(
      text, "settings of a training",
      [](const Json& json, TrainingOptions& options) { json.get_to(options); });
}

absl::StatusOr<std::vector<std::string>> NamesFromJson(const std::string& text) {
  return Parse<std::vector<std::string>>(
      text, "readers of a journey",
      [](const Json& json, std::vector<std::string>& names) { json.get_to(names); });
}

}  // namespace homing::storage
