#include <map>
#include <memory>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/camera_observations.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/json_line.h"
#include "client/command/progress.h"
#include "client/homing_client.h"
#include "client/journey_client.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

struct LocalizeFlags {
  RobotFlags robot;
  std::string journey;
  std::string travel = "return";
  double threshold = 0.20;
  int matches = 10;
  int tolerance = 10;
  int window = LocalizingOptions().window;
  std::optional<double> match_probability;
  std::optional<double> unknown_probability;
  bool paper_only = false;
};

LocalizingOptions MakeOptions(const LocalizeFlags& flags) {
  LocalizingOptions options;
  options.window = flags.window;
  v1::LocalizeConfig& config = options.config;
  config.set_journey(flags.journey);
  config.set_travel(ToTravel(flags.travel));
  if (!flags.robot.left_camera.empty()) {
    *config.mutable_left_camera() = flags.robot.left_intrinsics();
  }
  if (!flags.robot.right_camera.empty()) {
    *config.mutable_right_camera() = flags.robot.right_intrinsics();
  }
  config.set_max_matches(flags.matches);
  config.set_threshold(flags.threshold);
  config.set_tolerance_steps(flags.tolerance);
  if (flags.match_probability) config.set_match_probability(*flags.match_probability);
  if (flags.unknown_probability) config.set_unknown_probability(*flags.unknown_probability);
  config.set_paper_only(flags.paper_only);
  return options;
}

std::string AnswerHeader() {
  return absl::StrFormat("%8s  %-13s  %-8s  %6s  %5s  %8s  %-8s  %8s  %5s", "sequence", "outcome",
                         "motion", "step", "prob", "home", "heading", "landmark", "P_T");
}

std::string AnswerRow(const v1::LocalizeResponse& answer) {
  const auto or_dash = [](bool known, const std::string& text) { return known ? text : "-"; };
  return absl::StrFormat(
      "%8d  %-13s  %-8s  %6s  %5.2f  %8s  %-8s  %8s  %5s", answer.sequence(),
      Word(answer.outcome()), Word(answer.motion()),
      or_dash(answer.has_step(), absl::StrCat(answer.step())), answer.probability(),
      or_dash(answer.has_progress_home(), absl::StrFormat("%.1f %%", 100 * answer.progress_home())),
      Word(answer.direction()), or_dash(answer.has_landmark(), absl::StrCat(answer.landmark())),
      or_dash(answer.has_similarity(), absl::StrFormat("%.2f", answer.similarity())));
}

absl::StatusOr<std::unique_ptr<CameraObservations>> OpenRobot(
    const LocalizeFlags& flags, JourneyClient& journeys, std::unique_ptr<CameraInstants> instants) {
  std::optional<FlowOptions> flow;
  if (flags.robot.sends_flow()) {
    HOMING_ASSIGN_OR_RETURN(flow, FlowOptionsOf(journeys, flags.journey));
  }
  return std::make_unique<CameraObservations>(std::move(instants), flow);
}

absl::Status Localize(const Session& session, const LocalizeFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(flags.robot.left, flags.robot.right));
  HOMING_ASSIGN_OR_RETURN(
      auto instants,
      CameraInstants::Create(std::move(cameras), session.WithReports(flags.robot.frames)));
  CameraInstants* const sources = instants.get();
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient journeys(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const auto observations, OpenRobot(flags, journeys, std::move(instants)));
  HomingClient client(&connection, [&](const std::string& text) { session.Log(text); });
  Progress progress("localizing", observations->size(), session.json && !session.quiet);
  if (!session.json) HOMING_RETURN_IF_ERROR(session.Print(AnswerHeader()));
  std::map<std::string, int> outcomes;
  const auto on_answer = [&](const v1::LocalizeResponse& answer) {
    progress.Set(answer.sequence() + 1);
    ++outcomes[Word(answer.outcome())];
    if (!session.json) return session.Print(AnswerRow(answer));
    Json line = ToJson(answer);
    line["frame"] = observations->FrameOf(answer.sequence());
    return session.PrintJson(line);
  };
  // A stop ends a live source, and with it the stream.
  const absl::Status done = client.Localize(MakeOptions(flags), observations.get(), on_answer,
                                            sources->live() ? std::stop_token() : session.stop);
  sources->ReportTotal();
  HOMING_RETURN_IF_ERROR(done);
  std::string summary = "done:";
  for (const auto& [outcome, count] : outcomes) absl::StrAppend(&summary, " ", outcome, " ", count);
  session.Log(summary);
  return absl::OkStatus();
}

}  // namespace

void AddLocalizeCommand(CLI::App& app, Session& session) {
  CLI::App& command =
      *app.add_subcommand("localize", "Stream what the robot sees; one answer an observation");
  auto flags = std::make_shared<LocalizeFlags>();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/true);
  AddRobotFlags(command, flags->robot);
  AddTravelFlag(command, flags->travel);
  command.add_option("--threshold", flags->threshold, "Least P_T of a match")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--matches", flags->matches, "Most matches an answer")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--tolerance", flags->tolerance, "Half width of the interval, steps")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command
      .add_option("--match-probability", flags->match_probability,
                  "MATCH from this probability of the interval on [0.90]")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option("--unknown-probability", flags->unknown_probability,
                  "UNKNOWN_PLACE from this probability off the route on [0.50]")
      ->check(CLI::Range(0.0, 1.0));
  command.add_flag("--paper-only", flags->paper_only,
                   "Place the robot by the paper's P_T alone, not by flow profiles");
  command.add_option("--window", flags->window, "Most observations sent and not yet answered")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.callback([flags, &session] {
    RequireCamera(flags->robot);
    session.run = [flags, &session] { return Localize(session, *flags); };
  });
}

}  // namespace homing::client
