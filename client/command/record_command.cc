#include <memory>

#include "absl/strings/str_cat.h"
#include "client/camera_observations.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/json_line.h"
#include "client/command/progress.h"
#include "client/journey_client.h"
#include "client/map_quality.h"
#include "client/recording_client.h"
#include "client/source/source_mark.h"
#include "homing/base/range_check.h"
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
  bool resume = false;
};

// A journey to record on: by whom, and which observation the first frame of the source becomes.
struct Target {
  v1::Journey journey;
  std::string writer_id;
  std::int64_t base = 0;
};

// Models of the robot's cameras, as the flags or the sources give them.
using CameraModels = std::array<std::optional<v1::Camera>, 2>;

absl::StatusOr<v1::CreateJourneyRequest> MakeCreateRequest(const RecordFlags& flags,
                                                           const CameraModels& models) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(flags.journey));
  v1::CreateJourneyRequest request;
  request.set_parent(name.parent);
  request.set_journey_id(name.journey_id);
  v1::JourneySettings& settings = *request.mutable_journey()->mutable_settings();
  if (models[0]) *settings.mutable_left_camera() = *models[0];
  if (models[1]) *settings.mutable_right_camera() = *models[1];
  settings.set_deviation_model(flags.model);
  for (const std::string& reader : flags.readers) request.mutable_journey()->add_readers(reader);
  return request;
}

std::string Summarize(const v1::Journey& journey) {
  return absl::StrCat(journey.name(), ": ", journey.step_count(), " steps, ",
                      journey.landmark_count(), " landmarks, ", journey.fingerprint_count(),
                      " fingerprints");
}

absl::Status OtherSource(const v1::Journey& journey) {
  return absl::AlreadyExistsError(absl::StrCat(
      journey.name(), " is being recorded, with ", journey.next_sequence(),
      " observations, but not from this source; --resume appends the source to it, another name "
      "begins a new journey, and homing journeys finish closes it"));
}

// A journey of the same source continues where it stopped. For another source, or a live one, the
// user must ask for it with --resume.
absl::StatusOr<Target> OpenTarget(JourneyClient& journeys, const RecordFlags& flags,
                                  const CameraModels& models, const std::string& mark) {
  HOMING_ASSIGN_OR_RETURN(auto request, MakeCreateRequest(flags, models));
  Target target;
  target.writer_id = WriterWithMark(flags.writer, mark, 0);
  request.set_writer_id(target.writer_id);
  const auto created = journeys.Create(request);
  if (created.ok()) {
    target.journey = *created;
    const bool begun = created->next_sequence() > 0 && mark == kLiveMark;
    if (begun && !flags.resume) return OtherSource(*created);
    return target;
  }
  if (!absl::IsAlreadyExists(created.status())) return created.status();
  const auto found = journeys.Get(flags.journey);
  if (!found.ok() || found->state() != v1::Journey::STATE_ACTIVE) return created.status();
  target.journey = *found;
  target.base = BaseOfMark(found->source_mark(), mark);
  if (target.base <= 0 && !flags.resume) {
    // base is 0: the source is the same, but the settings or the writer differ.
    return target.base == 0 ? created.status() : OtherSource(*found);
  }
  if (target.base <= 0) target.base = found->next_sequence();
  target.writer_id = WriterWithMark(flags.writer, mark, target.base);
  return target;
}

absl::Status NotFinished(const RecordFlags& flags, const absl::Status& status) {
  return absl::Status(status.code(),
                      absl::StrCat(std::string(status.message()), "; ", flags.journey,
                                   " is not finished: run the same command again to continue where "
                                   "it stopped, or close it with homing journeys finish"));
}

absl::Status SendAll(const Session& session, const Connection& connection, const RecordFlags& flags,
                     const Target& target, CameraObservations& observations, bool live) {
  RecordingOptions options;
  options.journey = flags.journey;
  options.writer_id = target.writer_id;
  options.window = flags.window;
  RecordingClient client(&connection, options, [&](const std::string& text) { session.Log(text); });
  Progress progress("recording", observations.size(), !session.quiet);
  const auto on_answer = [&](const v1::RecordJourneyResponse& answer) {
    progress.Set(answer.frame() + 1);
    if (!session.json) return absl::OkStatus();
    Json line = ToJson(answer);
    // The index in the source, also where --every or bad frames leave frames out.
    line["frame"] = observations.FrameOf(answer.sequence());
    return session.PrintJson(line);
  };
  // A stop ends a live source, and with it the recording.
  const auto summary =
      client.Record(&observations, on_answer, live ? std::stop_token() : session.stop);
  if (summary.ok()) return absl::OkStatus();
  const bool goes_on = absl::IsCancelled(summary.status()) || absl::IsDataLoss(summary.status());
  return goes_on ? NotFinished(flags, summary.status()) : summary.status();
}

absl::StatusOr<v1::Journey> Close(JourneyClient& journeys, const RecordFlags& flags,
                                  const std::string& writer_id) {
  return flags.keep_open ? journeys.Get(flags.journey) : journeys.Finish(flags.journey, writer_id);
}

absl::Status Record(const Session& session, const RecordFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(flags.robot, session.stop));
  const CameraModels models = {CameraOf(flags.robot, cameras, Side::kLeft),
                               CameraOf(flags.robot, cameras, Side::kRight)};
  HOMING_ASSIGN_OR_RETURN(
      auto instants,
      CameraInstants::Create(std::move(cameras), session.WithReports(flags.robot.frames)));
  CameraInstants* const sources = instants.get();
  HOMING_ASSIGN_OR_RETURN(const std::string mark, MarkOfSource(flags.robot.left, flags.robot.right,
                                                               flags.robot.frames, *sources));
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  const bool live = sources->live();
  // After a stop the journey of a live source is still to be finished.
  JourneyClient journeys(&connection, live ? std::stop_token() : session.stop);
  HOMING_ASSIGN_OR_RETURN(const Target target, OpenTarget(journeys, flags, models, mark));
  std::optional<FlowOptions> flow;
  if (flags.robot.sends_flow()) {
    HOMING_ASSIGN_OR_RETURN(
        flow, wire::FromProto(target.journey.settings().flow(), "journey.settings.flow"));
  }
  CameraObservations observations(std::move(instants), flow);
  observations.StartAt(target.base);
  observations.StopAt(session.stop);
  const absl::Status sent = SendAll(session, connection, flags, target, observations, live);
  sources->ReportTotal();
  HOMING_RETURN_IF_ERROR(sent);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, Close(journeys, flags, target.writer_id));
  const MapQuality quality(journey);
  if (!quality.good) session.Log(absl::StrCat("the map is ", quality.Text()));
  return session.json ? absl::OkStatus() : session.Print(Summarize(journey));
}

}  // namespace

void AddRecordCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand("record",
                                          "Record an outbound journey and finish it; if it "
                                          "stops early, run it again with the same source "
                                          "to continue");
  auto flags = std::make_shared<RecordFlags>();
  flags->writer = DefaultWriter();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/false);
  AddRobotFlags(command, flags->robot);
  command.add_option("--model", flags->model,
                     "Deviation model, deviationModels/MODEL [the built-in default]");
  command
      .add_option("--writer", flags->writer,
                  "Id of the recording program; the same id can continue a journey")
      ->capture_default_str();
  command.add_option("--reader", flags->readers, "Robot that may read the journey, * for all");
  command.add_option("--window", flags->window, "Most observations sent and not yet durable")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_flag("--resume", flags->resume,
                   "Append to a journey that was begun from another source, or from a live one");
  command.add_flag("--no-finish", flags->keep_open, "Leave the journey open for more");
  command.callback([flags, &session] {
    RequireCamera(flags->robot);
    session.run = [flags, &session] { return Record(session, *flags); };
  });
}

}  // namespace homing::client
