#include "client/command/flags.h"

#include <unistd.h>

#include <array>
#include <fstream>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/frame_source.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "proto/wire/settings_conversion.h"

namespace homing::client {
namespace {

constexpr char kCameraForm[] = "fx,fy,cx,cy[,k1,k2,p1,p2,k3][,yaw=RAD]";

// CLI11 expects an error text, empty if the value is valid.
std::string Explain(const absl::Status& status) { return std::string(status.message()); }

absl::Status BadCamera(const std::string& text) { return TextMustBe("camera", text, kCameraForm); }

v1::Camera CameraOrNone(const std::string& text) {
  const auto camera = ParseCamera(text);
  return camera.ok() ? *camera : v1::Camera();
}

void AddFrameChoice(CLI::App& command, FrameChoice& frames) {
  command.add_option("--every", frames.every, "Take every N-th frame")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->capture_default_str();
  command
      .add_option("--fps", frames.fps,
                  "Take at most so many frames a second, by the times of the source [all]")
      ->check(CLI::Range(1e-3, 1e4));
  command
      .add_option("--seconds", frames.seconds,
                  "End after so many seconds of the source [at its end]")
      ->check(CLI::Range(1e-3, 1e9));
  CLI::Option* strict = command.add_flag(
      "--strict", frames.strict,
      "End at a bad frame, and refuse frames of one camera that have no partner of the other");
  command
      .add_flag_function(
          "--skip-bad-frames", [&frames](std::int64_t) { frames.strict = false; },
          "Skip and report them (empty, damaged, of another size): this is the default")
      ->excludes(strict);
}

}  // namespace

absl::StatusOr<v1::Camera> ParseCamera(const std::string& text) {
  v1::Camera camera;
  std::vector<double> values;
  for (const auto& part : absl::StrSplit(text, ',')) {
    const bool yaw = absl::StartsWith(part, "yaw=");
    double value = 0;
    if (!absl::SimpleAtod(yaw ? part.substr(4) : part, &value)) return BadCamera(text);
    if (yaw) {
      camera.set_yaw_rad(value);
    } else {
      values.push_back(value);
    }
  }
  if (values.size() != 4 && values.size() != 9) return BadCamera(text);
  camera.set_focal_x(values[0]);
  camera.set_focal_y(values[1]);
  camera.set_center_x(values[2]);
  camera.set_center_y(values[3]);
  for (std::size_t i = 4; i < values.size(); ++i) camera.add_distortion(values[i]);
  return camera;
}

v1::Camera RobotFlags::left_intrinsics() const { return CameraOrNone(left_camera); }
v1::Camera RobotFlags::right_intrinsics() const { return CameraOrNone(right_camera); }

void AddRobotFlags(CLI::App& command, RobotFlags& flags) {
  const auto check_source = [](const std::string& text) { return Explain(CheckSourceText(text)); };
  const auto check_camera = [](const std::string& text) {
    return Explain(ParseCamera(text).status());
  };
  const std::string camera_help =
      absl::StrCat("Pinhole camera ", kCameraForm, ", pixels and radians");
  command
      .add_option("--left", flags.left,
                  "SOURCE of the robot's left camera: a folder or glob of images in natural order, "
                  "a video file, a camera /dev/videoN, or sim:SCENE[,key=value...]")
      ->check(check_source);
  command.add_option("--right", flags.right, "SOURCE of the robot's right camera")
      ->check(check_source);
  command.add_option("--left-camera", flags.left_camera, camera_help)->check(check_camera);
  command.add_option("--right-camera", flags.right_camera, camera_help)->check(check_camera);
  command.add_option("--send", flags.send, "Send the frames, or flow vectors computed here")
      ->check(CLI::IsMember({"frames", "flow"}))
      ->capture_default_str();
  AddFrameChoice(command, flags.frames);
}

void RequireCamera(const RobotFlags& flags) {
  if (flags.left.empty() && flags.right.empty()) {
    throw CLI::RequiredError("--left SOURCE, --right SOURCE or both");
  }
}

CLI::Option* AddJourneyFlag(CLI::App& command, std::string& journey, bool wildcards) {
  const std::string help = absl::StrCat("robots/ROBOT/journeys/JOURNEY",
                                        wildcards ? "; either part may be - for all" : "");
  return command.add_option("--journey", journey, help)
      ->required()
      ->check([](const std::string& text) { return Explain(ParseJourneyName(text).status()); });
}

void AddTravelFlag(CLI::App& command, std::string& travel) {
  command
      .add_option("--travel", travel,
                  "return: the robot heads the other way, its cameras have changed sides of the "
                  "route; same: they have not")
      ->check(CLI::IsMember({"return", "same"}))
      ->capture_default_str();
}

v1::Travel ToTravel(const std::string& travel) {
  return travel == "same" ? v1::TRAVEL_SAME : v1::TRAVEL_RETURN;
}

absl::StatusOr<FlowOptions> FlowOptionsOf(JourneyClient& journeys, const std::string& journey) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(journey));
  if (name.journey_id != "-" && name.parent != "robots/-") {
    HOMING_ASSIGN_OR_RETURN(const v1::Journey found, journeys.Get(journey));
    return wire::FromProto(found.settings().flow(), "journey.settings.flow");
  }
  std::optional<v1::Journey> first;
  HOMING_RETURN_IF_ERROR(journeys.List(name.parent, [&](const v1::Journey& found) {
    const bool covered =
        name.journey_id == "-" || absl::EndsWith(found.name(), absl::StrCat("/", name.journey_id));
    if (covered && !first) first = found;
    return absl::OkStatus();
  }));
  if (!first) return absl::NotFoundError(absl::StrCat("no journey is covered by ", journey));
  return wire::FromProto(first->settings().flow(), "journey.settings.flow");
}

std::string DefaultWriter() {
  std::string id;
  std::ifstream file("/etc/machine-id");
  if (std::getline(file, id) && !id.empty()) return id;
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) == 0 && host[0] != '\0') return host.data();
  return "homing";
}

}  // namespace homing::client
