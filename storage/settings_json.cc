#include "storage/settings_json.h"

#include <concepts>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace homing::storage {
namespace {

using Json = nlohmann::json;

template <typename T, typename Options>
concept Is = std::same_as<std::remove_const_t<T>, Options>;

// Names and fields of each struct, used by writing and reading.
template <Is<Intrinsics> T, typename Visit>
void VisitFields(T& intrinsics, Visit visit) {
  visit("focal_x", intrinsics.focal_x);
  visit("focal_y", intrinsics.focal_y);
  visit("center_x", intrinsics.center_x);
  visit("center_y", intrinsics.center_y);
}

template <Is<FlowOptions> T, typename Visit>
void VisitFields(T& options, Visit visit) {
  visit("working_width_px", options.working_width_px);
  visit("smoothing_sigma_px", options.smoothing_sigma_px);
  visit("normalization_window_px", options.normalization_window_px);
  visit("normalization_floor", options.normalization_floor);
  visit("min_eigenvalue", options.min_eigenvalue);
  visit("cell_px", options.cell_px);
  visit("window_px", options.window_px);
  visit("pyramid_levels", options.pyramid_levels);
  visit("max_forward_backward_px", options.max_forward_backward_px);
}

template <Is<LandmarkOptions> T, typename Visit>
void VisitFields(T& options, Visit visit) {
  visit("min_vector_length_px", options.min_vector_length_px);
  visit("min_vectors", options.min_vectors);
  visit("histogram_bins", options.histogram_bins);
  visit("max_valley_ratio", options.max_valley_ratio);
  visit("min_peak_share", options.min_peak_share);
  visit("max_track_distance_px", options.max_track_distance_px);
  visit("max_track_gap_steps", options.max_track_gap_steps);
}

template <Is<DeviationModel> T, typename Visit>
void VisitFields(T& model, Visit visit) {
  visit("mu", model.mu);
  visit("sigma", model.sigma);
  visit("observations", model.observations);
  visit("ks_distance", model.ks_distance);
  visit("width", model.width);
  visit("height", model.height);
}

template <Is<TrainingOptions> T, typename Visit>
void VisitFields(T& options, Visit visit) {
  visit("width", options.width);
  visit("height", options.height);
  visit("focal_px", options.focal_px);
  visit("observations", options.observations);
  visit("seed", options.seed);
  visit("velocity_mean_kmh", options.velocity_mean_kmh);
  visit("velocity_deviation_kmh", options.velocity_deviation_kmh);
  visit("distance_mean_m", options.distance_mean_m);
  visit("distance_deviation_m", options.distance_deviation_m);
  visit("lateral_offset_m", options.lateral_offset_m);
  visit("vertical_offset_m", options.vertical_offset_m);
  visit("elapsed_s", options.elapsed_s);
  visit("frame_interval_s", options.frame_interval_s);
}

template <typename Options>
Json FieldsToJson(const Options& options) {
  Json json = Json::object();
  VisitFields(options, [&](const char* name, const auto& field) { json[name] = field; });
  return json;
}

template <typename Options>
void FieldsFromJson(const Json& json, Options& options) {
  VisitFields(options, [&](const char* name, auto& field) { json.at(name).get_to(field); });
}

// Five values, as ever, unless the lens has more.
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
  // Written only where it says something, so that other cameras read as before.
  if (camera.fisheye) json["fisheye"] = true;
  if (camera.intrinsics) json["intrinsics"] = FieldsToJson(*camera.intrinsics);
  return json;
}

void CameraFromJson(const Json& json, Camera& camera) {
  json.at("width").get_to(camera.width);
  json.at("height").get_to(camera.height);
  DistortionFromJson(json.at("distortion"), camera);
  camera.fisheye = json.value("fisheye", false);
  json.at("yaw_rad").get_to(camera.yaw_rad);
  if (json.contains("intrinsics")) {
    FieldsFromJson(json["intrinsics"], camera.intrinsics.emplace());
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
        absl::StrCat("store: ", what, " are not the JSON expected: ", exception.what()));
  }
}

}  // namespace

std::string ToJson(const JourneySettings& settings) {
  const Json json = {{"left_camera", CameraToJson(settings.cameras[0])},
                     {"right_camera", CameraToJson(settings.cameras[1])},
                     {"flow", FieldsToJson(settings.flow)},
                     {"landmark", FieldsToJson(settings.landmark)},
                     {"deviation_model_name", settings.deviation_model_name},
                     {"deviation_model", FieldsToJson(settings.deviation_model)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const TrainingOptions& options) { return FieldsToJson(options).dump(); }

std::string ToJson(const std::vector<std::string>& names) {
  return Json(names).dump(-1, ' ', false, Json::error_handler_t::replace);
}

absl::StatusOr<JourneySettings> JourneySettingsFromJson(const std::string& text) {
  return Parse<JourneySettings>(
      text, "settings of a journey", [](const Json& json, JourneySettings& settings) {
        CameraFromJson(json.at("left_camera"), settings.cameras[0]);
        CameraFromJson(json.at("right_camera"), settings.cameras[1]);
        FieldsFromJson(json.at("flow"), settings.flow);
        FieldsFromJson(json.at("landmark"), settings.landmark);
        json.at("deviation_model_name").get_to(settings.deviation_model_name);
        FieldsFromJson(json.at("deviation_model"), settings.deviation_model);
      });
}

absl::StatusOr<TrainingOptions> TrainingOptionsFromJson(const std::string& text) {
  return Parse<TrainingOptions>(
      text, "settings of a training",
      [](const Json& json, TrainingOptions& options) { FieldsFromJson(json, options); });
}

absl::StatusOr<std::vector<std::string>> NamesFromJson(const std::string& text) {
  return Parse<std::vector<std::string>>(
      text, "readers of a journey",
      [](const Json& json, std::vector<std::string>& names) { json.get_to(names); });
}

}  // namespace homing::storage
