#include <memory>

#include "absl/strings/str_cat.h"
#include "client/camera_observations.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/json_line.h"
#include "client/command/progress.h"
#include "client/journey_client.h"
#include "client/recording_client.h"
#include "homing/base/status_macros.h"
#include "proto/wire/settings_conversion.h"

namespace homing::client {
namespace {

struct RecordFlags {
  RobotFlags robot;
  std::string journey;
  std::string model;
  std::string writer;
  std::vector<std::string> readers;
  int window = RecordingOptions().window;
  bool keep_open = false;
};

absl::StatusOr<v1::CreateJourneyRequest> MakeCreateRequest(const RecordFlags& flags,
                                                           const Cameras& cameras) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(flags.journey));
  v1::CreateJourneyRequest request;
  request.set_parent(name.parent);
  request.set_journey_id(name.journey_id);
  request.set_writer_id(flags.writer);
  v1::JourneySettings& settings = *request.mutable_journey()->mutable_settings();
  if (auto camera = CameraOf(flags.robot, cameras, Side::kLeft)) {
    *settings.mutable_left_camera() = *std::move(camera);
  }
  if (auto camera = CameraOf(flags.robot, cameras, Side::kRight)) {
    *settings.mutable_right_camera() = *std::move(camera);
  }
  settings.set_deviation_model(flags.model);
  for (const std::string& reader : flags.readers) request.mutable_journey()->add_readers(reader);
  return request;
}

std::string Summarize(const v1::Journey& journey) {
  return absl::StrCat(journey.name(), ": ", journey.step_count(), " steps, ",
                      journey.landmark_count(), " landmarks, ", journey.fingerprint_count(),
                      " fingerprints");
}

absl::Status SendAll(const Session& session, const Connection& connection, const RecordFlags& flags,
                     CameraObservations& observations) {
  RecordingOptions options;
  options.journey = flags.journey;
  options.writer_id = flags.writer;
  options.window = flags.window;
  RecordingClient client(&connection, options, [&](const std::string& text) { session.Log(text); });
  Progress progress("recording", observations.size(), !session.quiet);
  const auto on_answer = [&](const v1::RecordJourneyResponse& answer) {
    progress.Set(answer.frame() + 1);
    return session.json ? session.PrintJson(ToJson(answer)) : absl::OkStatus();
  };
  const auto summary = client.Record(&observations, on_answer, session.stop);
  if (absl::IsCancelled(summary.status())) {
    return absl::CancelledError(absl::StrCat(
        flags.journey, " is not finished; run the same command again to go on where it stopped"));
  }
  return summary.status();
}

absl::Status Record(const Session& session, const RecordFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(flags.robot));
  for (const std::string& line : RemarksOn(cameras)) session.Log(line);
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient journeys(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const auto request, MakeCreateRequest(flags, cameras));
  HOMING_ASSIGN_OR_RETURN(v1::Journey journey, journeys.Create(request));
  std::optional<FlowOptions> flow;
  if (flags.robot.sends_flow()) {
    HOMING_ASSIGN_OR_RETURN(flow,
                            wire::FromProto(journey.settings().flow(), "journey.settings.flow"));
  }
  CameraObservations observations(std::move(cameras), flow);
  observations.StopAt(session.stop);
  HOMING_RETURN_IF_ERROR(SendAll(session, connection, flags, observations));
  if (flags.keep_open) {
    HOMING_ASSIGN_OR_RETURN(journey, journeys.Get(flags.journey));
  } else {
    HOMING_ASSIGN_OR_RETURN(journey, journeys.Finish(flags.journey, flags.writer));
  }
  return session.json ? absl::OkStatus() : session.Print(Summarize(journey));
}

}  // namespace

void AddRecordCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "record", "Record an outbound journey and finish it; run again, it goes on where it stopped");
  auto flags = std::make_shared<RecordFlags>();
  flags->writer = DefaultWriter();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/false);
  AddRobotFlags(command, flags->robot);
  command.add_option("--model", flags->model,
                     "Deviation model, deviationModels/MODEL [the built-in default]");
  command.add_option("--writer", flags->writer, "Who records; the same writer may go on")
      ->capture_default_str();
  command.add_option("--reader", flags->readers, "Robot that may read the journey, * for all");
  command.add_option("--window", flags->window, "Most observations sent and not yet durable")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_flag("--no-finish", flags->keep_open, "Leave the journey open for more");
  command.callback([flags, &session] {
    RequireCamera(flags->robot);
    session.run = [flags, &session] { return Record(session, *flags); };
  });
}

}  // namespace homing::client
