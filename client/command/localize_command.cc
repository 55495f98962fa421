#include <cerrno>
#include <fstream>
#include <map>
#include <memory>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/camera_observations.h"
#include "client/command/answer_bag.h"
#include "client/command/answer_table.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/growing_file.h"
#include "client/command/json_line.h"
#include "client/command/progress.h"
#include "client/command/real_range.h"
#include "client/file/output_file.h"
#include "client/homing_client.h"
#include "client/journey_client.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

struct LocalizeFlags {
  RobotFlags robot;
  std::string journey;
  std::string travel = "return";
  std::string robot_name;
  double threshold = 0.20;
  int matches = 10;
  int tolerance = 10;
  int window = LocalizingOptions().window;
  std::optional<double> match_probability;
  std::optional<double> unknown_probability;
  bool paper_only = false;
  std::string mcap_out;
  std::string csv;
};

LocalizingOptions MakeOptions(const LocalizeFlags& flags, const Cameras& cameras) {
  LocalizingOptions options;
  options.window = flags.window;
  v1::LocalizeConfig& config = options.config;
  config.set_journey(flags.journey);
  config.set_robot(flags.robot_name);
  config.set_travel(ToTravel(flags.travel));
  if (auto camera = CameraOf(flags.robot, cameras, Side::kLeft)) {
    *config.mutable_left_camera() = *std::move(camera);
  }
  if (auto camera = CameraOf(flags.robot, cameras, Side::kRight)) {
    *config.mutable_right_camera() = *std::move(camera);
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

// Writes the answers to stdout, and to the requested files.
class AnswerOutputs {
 public:
  AnswerOutputs(const Session& session, const LocalizeFlags& flags)
      : session_(session), flags_(flags) {}

  absl::Status Open(const std::optional<FlowOptions>& flow) {
    if (!flags_.csv.empty()) {
      HOMING_ASSIGN_OR_RETURN(table_, OpenGrowingFile(flags_.csv, session_.stop));
      *table_ << AnswerTableHead() << std::endl;
    }
    if (!flags_.mcap_out.empty()) {
      HOMING_ASSIGN_OR_RETURN(bag_, AnswerBag::Open(flags_.mcap_out, *flow, session_.stop));
    }
    return session_.json ? absl::OkStatus() : session_.Print(AnswerHeader());
  }

  AnswerBag* bag() { return bag_.get(); }

  absl::Status Add(const v1::LocalizeResponse& answer) {
    errno = 0;
    if (table_ && !(*table_ << AnswerTableLine(answer) << std::endl)) {
      table_.reset();
      Lose(CannotWrite(flags_.csv, errno == 0 ? ENOSPC : errno));
    }
    if (bag_ != nullptr) Lose(bag_->Add(answer));
    return session_.json ? session_.PrintJson(ToJson(answer)) : session_.Print(AnswerRow(answer));
  }

  absl::Status Finish() {
    if (bag_ != nullptr) lost_.Update(bag_->Finish());
    return lost_;
  }

 private:
  // A full disk must not leave a robot without answers: they continue without the file.
  void Lose(const absl::Status& status) {
    if (status.ok()) return;
    session_.Log(absl::StrCat(std::string(status.message()),
                              "; the answers continue without this file: make room or name "
                              "another place, then start again"));
    lost_.Update(status);
  }

  const Session& session_;
  const LocalizeFlags& flags_;
  std::optional<std::ofstream> table_;
  // The first file that could not be written.
  absl::Status lost_;
  std::unique_ptr<AnswerBag> bag_;
};

absl::Status Localize(const Session& session, const LocalizeFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(flags.robot, session.stop));
  const LocalizingOptions options = MakeOptions(flags, cameras);
  HOMING_ASSIGN_OR_RETURN(
      auto instants,
      CameraInstants::Create(std::move(cameras), session.WithReports(flags.robot.frames)));
  CameraInstants* const sources = instants.get();
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient journeys(&connection, session.stop);
  std::optional<FlowOptions> flow;
  if (flags.robot.sends_flow() || !flags.mcap_out.empty()) {
    HOMING_ASSIGN_OR_RETURN(flow, FlowOptionsOf(journeys, flags.journey));
  }
  CameraObservations observations(std::move(instants),
                                  flags.robot.sends_flow() ? flow : std::nullopt);
  observations.StopAt(session.stop);
  HomingClient client(&connection, [&](const std::string& text) { session.Log(text); });
  Progress progress("localizing", observations.size(), session.json && !session.quiet);
  AnswerOutputs outputs(session, flags);
  HOMING_RETURN_IF_ERROR(outputs.Open(flow));
  std::map<std::string, int> outcomes;
  const auto on_answer = [&](v1::LocalizeResponse answer) {
    progress.Set(answer.frame() + 1);
    ++outcomes[Word(answer.outcome())];
    // The index in the source, also where --every or bad frames leave frames out.
    answer.set_frame(observations.FrameOf(answer.sequence()));
    return outputs.Add(answer);
  };
  const auto watched = outputs.bag() ? outputs.bag()->Watch(&observations) : nullptr;
  // A stop ends a live source, and with it the stream.
  const absl::Status status =
      client.Localize(options, watched ? watched.get() : &observations, on_answer,
                      sources->live() ? std::stop_token() : session.stop);
  sources->ReportTotal();
  // Also after an error, so that the answers so far can be viewed.
  const absl::Status finished = outputs.Finish();
  HOMING_RETURN_IF_ERROR(status);
  HOMING_RETURN_IF_ERROR(finished);
  std::string summary = "done:";
  for (const auto& [outcome, count] : outcomes) absl::StrAppend(&summary, " ", outcome, " ", count);
  session.Log(summary);
  return absl::OkStatus();
}

}  // namespace

void AddLocalizeCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "localize", "Stream a robot's frames or flow; each observation gets one answer");
  auto flags = std::make_shared<LocalizeFlags>();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/true);
  AddRobotFlags(command, flags->robot);
  AddTravelFlag(command, flags->travel);
  command.add_option(
      "--robot", flags->robot_name,
      "robots/ROBOT that localises, as `homing top` shows it; by default the robot in the "
      "journey's name");
  command.add_option("--threshold", flags->threshold, "Least P_T of a match")
      ->check(RealRange(0.0, 1.0))
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
      ->check(RealRange(0.0, 1.0));
  command
      .add_option("--unknown-probability", flags->unknown_probability,
                  "UNKNOWN_PLACE from this probability off the route on [0.50]")
      ->check(RealRange(0.0, 1.0));
  command.add_flag("--paper-only", flags->paper_only,
                   "Place the robot by the paper's P_T alone, not by flow profiles");
  command.add_option("--window", flags->window, "Most observations sent and not yet answered")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_option("--mcap-out", flags->mcap_out,
                     "Also write an MCAP file: images, flow, landmarks and answers, for Foxglove");
  command.add_option("--csv", flags->csv, "Also write the answers as comma-separated values");
  command.callback([flags, &session] {
    RequireCamera(flags->robot);
    session.run = [flags, &session] { return Localize(session, *flags); };
  });
}

}  // namespace homing::client
