#include <memory>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/image_pair.h"
#include "client/command/json_line.h"
#include "client/journey_client.h"
#include "client/picture/flow_picture.h"
#include "client/picture/journey_strip.h"
#include "homing/base/status_macros.h"
#include "homing/flow/flow_tracker.h"
#include "proto/wire/enum_conversion.h"

namespace homing::client {
namespace {

struct DrawFlags {
  std::string journey;
  std::optional<std::int64_t> step;
  std::string left;
  std::string right;
  std::string reference_left;
  std::string reference_right;
  bool histogram = false;
  std::string out;
};

absl::StatusOr<FlowField> FlowOfPair(const ImagePair& pair) {
  HOMING_ASSIGN_OR_RETURN(const cv::Mat first, DecodeGray(pair.first.view()));
  HOMING_ASSIGN_OR_RETURN(const cv::Mat second, DecodeGray(pair.second.view()));
  FlowTracker tracker{FlowOptions()};
  HOMING_RETURN_IF_ERROR(tracker.Track(first).status());
  tracker.Advance();
  HOMING_ASSIGN_OR_RETURN(auto field, tracker.Track(second));
  return field ? *std::move(field) : FlowField{second.cols, second.rows, {}};
}

absl::StatusOr<GrayImage> Backdrop(const ImagePair& pair) {
  HOMING_ASSIGN_OR_RETURN(const cv::Mat gray, DecodeGray(pair.second.view()));
  const cv::Mat packed = gray.isContinuous() ? gray : gray.clone();
  return GrayImage{packed.cols, packed.rows,
                   std::string(reinterpret_cast<const char*>(packed.data), packed.total())};
}

absl::StatusOr<FlowPanel> MakePanel(const std::string& title, const std::string& images,
                                    const std::string& reference) {
  HOMING_ASSIGN_OR_RETURN(const ImagePair pair, ReadImagePair(images));
  FlowPanel panel;
  HOMING_ASSIGN_OR_RETURN(panel.field, FlowOfPair(pair));
  panel.title = absl::StrFormat("%s camera, %d vectors", title, panel.field.vectors.size());
  if (reference.empty()) {
    HOMING_ASSIGN_OR_RETURN(panel.image, Backdrop(pair));
    return panel;
  }
  HOMING_ASSIGN_OR_RETURN(const ImagePair reference_pair, ReadImagePair(reference));
  HOMING_ASSIGN_OR_RETURN(panel.reference, FlowOfPair(reference_pair));
  absl::StrAppend(&panel.title, " (blue) against the reference (green)");
  return panel;
}

absl::Status DrawFrames(const DrawFlags& flags) {
  std::vector<FlowPanel> panels;
  if (!flags.left.empty()) {
    HOMING_ASSIGN_OR_RETURN(FlowPanel panel, MakePanel("left", flags.left, flags.reference_left));
    panels.push_back(std::move(panel));
  }
  if (!flags.right.empty()) {
    HOMING_ASSIGN_OR_RETURN(FlowPanel panel,
                            MakePanel("right", flags.right, flags.reference_right));
    panels.push_back(std::move(panel));
  }
  FlowPictureOptions options;
  options.histogram = flags.histogram;
  return DrawFlow(flags.out, panels, options);
}

absl::Status AddFingerprints(const v1::Landmark& landmark, JourneyStrip& strip) {
  HOMING_ASSIGN_OR_RETURN(const Side side, wire::FromProto(landmark.side(), "landmark.side"));
  const int count = landmark.steps_size();
  if (landmark.xs_size() != count || landmark.ys_size() != count ||
      landmark.counts_size() != count) {
    return absl::InternalError("the server's columns of fingerprints differ in length");
  }
  for (int i = 0; i < count; ++i) {
    strip.fingerprints.push_back(
        {landmark.steps(i),
         side,
         {landmark.xs(i), landmark.ys(i), landmark.counts(i), landmark.landmark()}});
  }
  return absl::OkStatus();
}

absl::StatusOr<JourneyStrip> FetchStrip(const Session& session, const std::string& name) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, client.Get(name));
  JourneyStrip strip;
  strip.title =
      absl::StrFormat("%s: %d steps, %d landmarks, %d fingerprints", journey.name(),
                      journey.step_count(), journey.landmark_count(), journey.fingerprint_count());
  strip.step_count = journey.step_count();
  const v1::JourneySettings& settings = journey.settings();
  strip.widths = {settings.left_camera().width(), settings.right_camera().width()};
  strip.heights = {settings.left_camera().height(), settings.right_camera().height()};
  HOMING_RETURN_IF_ERROR(client.ListLandmarks(
      name, true, [&](const v1::Landmark& landmark) { return AddFingerprints(landmark, strip); }));
  return strip;
}

absl::Status DrawJourney(const Session& session, const DrawFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const JourneyStrip strip, FetchStrip(session, flags.journey));
  if (!flags.step) return DrawJourneyStrip(flags.out, strip);
  if (*flags.step < 0 || *flags.step >= strip.step_count) {
    return absl::OutOfRangeError(absl::StrCat(
        "--step is ", *flags.step, "; the journey has steps 0 to ", strip.step_count - 1));
  }
  return DrawJourneyStep(flags.out, strip, *flags.step);
}

absl::Status Draw(const Session& session, const DrawFlags& flags) {
  HOMING_RETURN_IF_ERROR(flags.journey.empty() ? DrawFrames(flags) : DrawJourney(session, flags));
  return session.json ? session.PrintJson(Json{{"file", flags.out}}) : session.Print(flags.out);
}

void CheckDrawFlags(const DrawFlags& flags) {
  const bool frames = !flags.left.empty() || !flags.right.empty();
  if (frames == !flags.journey.empty()) {
    throw CLI::RequiredError("either --journey NAME, or --left FIRST,SECOND and/or --right");
  }
}

}  // namespace

void AddDrawCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "draw", "Pictures: a journey's map as a strip, one step of it, or the flow of a frame pair");
  auto flags = std::make_shared<DrawFlags>();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/false)->required(false);
  command.add_option("--step", flags->step, "One step of the journey");
  command
      .add_option("--left", flags->left,
                  "FIRST,SECOND: flow vectors and landmarks of two frames; needs no server")
      ->check(CheckImagePair);
  command.add_option("--right", flags->right, "The same of the right camera")
      ->check(CheckImagePair);
  command
      .add_option("--reference-left", flags->reference_left,
                  "FIRST,SECOND: compare with the flow of these two (the paper's Figs 5 to 7)")
      ->check(CheckImagePair);
  command.add_option("--reference-right", flags->reference_right, "The same of the right camera")
      ->check(CheckImagePair);
  command.add_flag("--histogram", flags->histogram,
                   "Also the histogram of midpoints with its valley (Fig. 4)");
  command.add_option("--out", flags->out, "FILE.svg or FILE.png")->required();
  command.callback([flags, &session] {
    CheckDrawFlags(*flags);
    session.run = [flags, &session] { return Draw(session, *flags); };
  });
}

}  // namespace homing::client
