#include <filesystem>
#include <memory>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/json_line.h"
#include "client/model_client.h"
#include "client/picture/deviation_picture.h"
#include "homing/base/status_macros.h"
#include "proto/wire/settings_conversion.h"

namespace homing::client {
namespace {

struct TrainFlags {
  std::string model;
  v1::TrainingSettings settings;
  std::string plot;
};

using Setter = void (v1::TrainingSettings::*)(double);

void AddNumber(CLI::App& command, v1::TrainingSettings& settings, const std::string& flag,
               const std::string& help, Setter set) {
  command.add_option_function<double>(
      flag, [&settings, set](const double& value) { (settings.*set)(value); }, help);
}

void AddGeometry(CLI::App& command, v1::TrainingSettings& settings) {
  using Settings = v1::TrainingSettings;
  AddNumber(command, settings, "--focal", "Focal length, pixels [277]", &Settings::set_focal_px);
  AddNumber(command, settings, "--velocity", "Mean velocity, km/h [4]",
            &Settings::set_velocity_mean_kmh);
  AddNumber(command, settings, "--velocity-deviation",
            "Standard deviation of the velocity, km/h [1]", &Settings::set_velocity_deviation_kmh);
  AddNumber(command, settings, "--distance", "Mean distance, m [11]",
            &Settings::set_distance_mean_m);
  AddNumber(command, settings, "--distance-deviation", "Standard deviation of the distance, m [3]",
            &Settings::set_distance_deviation_m);
  AddNumber(command, settings, "--lateral",
            "Offset of the point along the travel at t = 0, m [2.75]",
            &Settings::set_lateral_offset_m);
  AddNumber(command, settings, "--vertical", "Vertical offset of the point, m [0.5]",
            &Settings::set_vertical_offset_m);
  AddNumber(command, settings, "--elapsed", "Time at which the vector is observed, s [1.1]",
            &Settings::set_elapsed_s);
  AddNumber(command, settings, "--interval", "Time between its two frames, s [0.1]",
            &Settings::set_frame_interval_s);
}

// The paper's Figs 1 and 2, each as SVG and PNG.
absl::Status PlotTraining(const std::string& folder,
                          const v1::TrainDeviationModelResponse& trained) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const DeviationModel model = wire::DeviationOf(trained.model());
  const std::vector<double> deviations(trained.deviations_px().begin(),
                                       trained.deviations_px().end());
  if (deviations.empty()) return absl::InternalError("the server returned no deviations to plot");
  for (const char* ending : {".svg", ".png"}) {
    HOMING_RETURN_IF_ERROR(DrawDeviationDensity(absl::StrCat(folder, "/deviation_density", ending),
                                                deviations, model));
    HOMING_RETURN_IF_ERROR(DrawDeviationDistribution(
        absl::StrCat(folder, "/deviation_distribution", ending), deviations, model));
  }
  return absl::OkStatus();
}

absl::Status Train(const Session& session, const TrainFlags& flags) {
  v1::TrainDeviationModelRequest request;
  request.set_model_id(absl::StartsWith(flags.model, "deviationModels/")
                           ? flags.model.substr(std::string("deviationModels/").size())
                           : flags.model);
  *request.mutable_settings() = flags.settings;
  request.set_include_deviations(!flags.plot.empty());
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  ModelClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const auto trained, client.Train(request));
  if (!flags.plot.empty()) HOMING_RETURN_IF_ERROR(PlotTraining(flags.plot, trained));
  const v1::DeviationModel& model = trained.model();
  if (session.json) return session.PrintJson(ToJson(model));
  return session.Print(absl::StrFormat("%s: mu %.4f, sigma %.4f, n %d, KS distance %.4f",
                                       model.name(), model.mu(), model.sigma(),
                                       model.observations(), model.ks_distance()));
}

}  // namespace

void AddTrainCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "train", "Train a deviation model on simulated observations and store it by name");
  auto flags = std::make_shared<TrainFlags>();
  command.add_option("--model", flags->model, "Name of the model [camera size and focal length]");
  command
      .add_option_function<int>(
          "--width", [s = &flags->settings](int v) { s->set_width(v); }, "Image width, pixels")
      ->required();
  command
      .add_option_function<int>(
          "--height", [s = &flags->settings](int v) { s->set_height(v); }, "Image height, pixels")
      ->required();
  AddGeometry(command, flags->settings);
  command.add_option_function<int>(
      "--observations", [s = &flags->settings](int v) { s->set_observations(v); },
      "n of eq 7 [1000]");
  command.add_option_function<std::uint64_t>(
      "--seed", [s = &flags->settings](std::uint64_t v) { s->set_seed(v); },
      "Seed of the draws [1]");
  command.add_option("--plot", flags->plot, "DIR for the pictures of the paper's Figs 1 and 2");
  command.callback([flags, &session] {
    if (flags->model.empty()) {
      flags->model = absl::StrCat(flags->settings.width(), "x", flags->settings.height());
      if (flags->settings.has_focal_px()) {
        absl::StrAppend(&flags->model, "-f", flags->settings.focal_px());
      }
    }
    session.run = [flags, &session] { return Train(session, *flags); };
  });
}

}  // namespace homing::client
