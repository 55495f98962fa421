#include <cmath>
#include <filesystem>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/camera_observations.h"
#include "client/command/commands.h"
#include "client/command/drive_output.h"
#include "client/command/flags.h"
#include "client/command/progress.h"
#include "client/command/real_range.h"
#include "client/drive/home_drive.h"
#include "client/journey_client.h"
#include "client/live_localizer.h"
#include "client/pilot_answer.h"
#include "client/recording_client.h"
#include "client/simulator/simulation_spec.h"
#include "homing/base/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

struct DriveFlags {
  std::string journey;
  std::string scene;
  std::string home_keys;
  std::string travel = "return";
  std::string folder;
  double start_left_m = 0.3;
  double start_heading_deg = 5;
  double slip = 0.2;
  double delay_ms = 100;
  double lost = 0;
  std::uint64_t seed = 1;
};

// The scene on the way out, and as it is on the way home.
std::string OutText(const DriveFlags& flags) { return absl::StrCat("sim:", flags.scene); }
absl::StatusOr<SimulationSpec> HomeSpec(const DriveFlags& flags) {
  return ParseSimulationSpec(
      absl::StrCat(OutText(flags), flags.home_keys.empty() ? "" : ",", flags.home_keys));
}

v1::Camera SimulatedCamera() {
  v1::Camera camera;
  camera.set_width(Simulator::kWidth);
  camera.set_height(Simulator::kHeight);
  camera.set_focal_x(Simulator::kFocal);
  camera.set_focal_y(Simulator::kFocal);
  camera.set_center_x(Simulator::kCenterX);
  camera.set_center_y(Simulator::kCenterY);
  return camera;
}

absl::StatusOr<v1::Journey> RecordOut(const Session& session, const Connection& connection,
                                      const DriveFlags& flags) {
  session.Log(absl::StrCat("recording the way out as ", flags.journey));
  JourneyClient journeys(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(flags.journey));
  v1::CreateJourneyRequest request;
  request.set_parent(name.parent);
  request.set_journey_id(name.journey_id);
  request.set_writer_id(DefaultWriter());
  *request.mutable_journey()->mutable_settings()->mutable_left_camera() = SimulatedCamera();
  *request.mutable_journey()->mutable_settings()->mutable_right_camera() = SimulatedCamera();
  HOMING_RETURN_IF_ERROR(journeys.Create(request).status());
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(OutText(flags), OutText(flags)));
  HOMING_ASSIGN_OR_RETURN(auto instants, CameraInstants::Create(std::move(cameras), FrameChoice()));
  CameraObservations observations(std::move(instants), std::nullopt);
  RecordingOptions options;
  options.journey = flags.journey;
  options.writer_id = DefaultWriter();
  RecordingClient client(&connection, options, [&](const std::string& text) { session.Log(text); });
  Progress progress("recording", observations.size(), !session.quiet);
  const auto on_answer = [&](const v1::RecordJourneyResponse& answer) {
    progress.Set(answer.frame() + 1);
    return absl::OkStatus();
  };
  HOMING_RETURN_IF_ERROR(client.Record(&observations, on_answer, session.stop).status());
  return journeys.Finish(flags.journey, DefaultWriter());
}

// The journey, recorded first if there is none of this name.
absl::StatusOr<v1::Journey> GetOrRecord(const Session& session, const Connection& connection,
                                        const DriveFlags& flags) {
  JourneyClient journeys(&connection, session.stop);
  auto journey = journeys.Get(flags.journey);
  return absl::IsNotFound(journey.status()) ? RecordOut(session, connection, flags) : journey;
}

// One answer at a time: the simulated robot's clock waits for it.
LocalizingOptions AnswersOf(const DriveFlags& flags, const v1::Journey& journey) {
  LocalizingOptions options;
  options.window = 1;
  v1::LocalizeConfig& config = options.config;
  config.set_journey(flags.journey);
  config.set_travel(ToTravel(flags.travel));
  *config.mutable_left_camera() = SimulatedCamera();
  *config.mutable_right_camera() = SimulatedCamera();
  // The robot knows that it stands where its way out ended.
  config.mutable_prior()->set_journey(flags.journey);
  config.mutable_prior()->set_step(std::max<std::int64_t>(0, journey.step_count() - 1));
  config.mutable_prior()->set_direction(v1::DIRECTION_HOMEWARD);
  config.mutable_prior()->set_probability(0.95);
  return options;
}

HomeDriveOptions OptionsOf(const DriveFlags& flags, const SimulationSpec& home) {
  HomeDriveOptions options;
  options.pilot.turn_round = flags.travel == "return";
  options.pilot.route_m = home.length_m;
  options.fps = home.fps;
  options.robot.slip = flags.slip;
  options.robot.seed = flags.seed;
  options.seed = flags.seed;
  options.start_left_m = flags.start_left_m;
  options.start_heading = flags.start_heading_deg * kDegree;
  options.delay_s = flags.delay_ms / 1000;
  options.lost = flags.lost;
  // The robot gives up after five times the time that the way needs.
  options.most_s = 60 + 5 * home.length_m / options.pilot.most_speed_mps;
  return options;
}

absl::Status Drive(const Session& session, const DriveFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const SimulationSpec home, HomeSpec(flags));
  HOMING_ASSIGN_OR_RETURN(const auto cameras, PosedCameras::Create(home));
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, GetOrRecord(session, connection, flags));
  LiveLocalizer localizer(&connection, AnswersOf(flags, journey),
                          [&](const std::string& text) { session.Log(text); });
  const HomeDriveOptions options = OptionsOf(flags, home);
  Progress progress("driving home", std::lround(home.length_m), !session.quiet);
  RenderedEyes eyes(cameras.get());
  const auto ask = [&](const Observation& seen) -> absl::StatusOr<PilotAnswer> {
    if (session.stop.stop_requested()) return absl::CancelledError("stopped");
    localizer.Send(wire::ToProto(seen));
    HOMING_ASSIGN_OR_RETURN(const v1::LocalizeResponse answer, localizer.Wait(session.stop));
    progress.Set(std::lround(home.length_m * answer.progress_home()));
    return ToPilotAnswer(answer, 0);
  };
  HOMING_ASSIGN_OR_RETURN(const HomeDrive drive, DriveHome(options, cameras->route(), &eyes, ask));
  return ReportDrive(session, drive, cameras->route(), options.pilot.route_m, flags.folder);
}

}  // namespace

void AddDriveCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "drive", "Drive the simulated robot home by the answers alone; records its way out first");
  auto flags = std::make_shared<DriveFlags>();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/false);
  command
      .add_option("--scene", flags->scene,
                  "street or landmarks, then [,key=value...] as for simulate: the way out")
      ->required()
      ->check([](const std::string& text) {
        return std::string(ParseSimulationSpec(absl::StrCat("sim:", text)).status().message());
      });
  command.add_option("--home", flags->home_keys,
                     "Keys that differ on the way home, key=value[,key=value...]: light, noise, "
                     "remove, drive");
  AddTravelFlag(command, flags->travel);
  command.add_option("--out", flags->folder, "DIR to write drive.png and drive.csv to");
  command
      .add_option("--start-left", flags->start_left_m,
                  "Start position to the left of the path, metres")
      ->check(RealRange(-2.0, 2.0))
      ->capture_default_str();
  command
      .add_option("--start-heading", flags->start_heading_deg,
                  "Start heading to the left of the path, degrees")
      ->check(RealRange(-45.0, 45.0))
      ->capture_default_str();
  command.add_option("--slip", flags->slip, "Greatest slip of a wheel, as a fraction")
      ->check(RealRange(0.0, 0.5))
      ->capture_default_str();
  command.add_option("--delay", flags->delay_ms, "Delay of the answers, ms")
      ->check(RealRange(0.0, 2000.0))
      ->capture_default_str();
  command.add_option("--lost", flags->lost, "Fraction of the answers that are lost")
      ->check(RealRange(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--seed", flags->seed, "Seed of slip, noise and losses")
      ->capture_default_str();
  command.callback(
      [flags, &session] { session.run = [flags, &session] { return Drive(session, *flags); }; });
}

}  // namespace homing::client
