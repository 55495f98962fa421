#include "client/command/flags.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <future>
#include <thread>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/calibration_file.h"
#include "client/command/real_range.h"
#include "client/source/frame_source.h"
#include "client/source/view_window.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "proto/wire/settings_conversion.h"

namespace homing::client {
namespace {

constexpr char kCameraForm[] = "fx,fy,cx,cy[,k1,k2,p1,p2,k3][,yaw=RAD] or FILE[#CAMERA][,yaw=RAD]";

constexpr std::chrono::milliseconds kStopCheck{50};

// Converts a status to CLI11's form: an error text, empty if the value is valid.
std::string Explain(const absl::Status& status) { return std::string(status.message()); }

absl::Status BadCamera(const std::string& text) { return TextMustBe("camera", text, kCameraForm); }

ViewWindow WindowOf(const RobotFlags& flags, Side side) {
  const bool right = side == Side::kRight;
  const std::string& crop = right && !flags.right_crop.empty() ? flags.right_crop : flags.crop;
  ViewWindow window;
  window.mask = right && !flags.right_mask.empty() ? flags.right_mask : flags.mask;
  if (const auto rectangle = ParseCrop(crop); rectangle.ok()) window.crop = *rectangle;
  return window;
}

v1::Camera CameraOrNone(const std::string& text) {
  const auto camera = ParseCamera(text);
  return camera.ok() ? *camera : v1::Camera();
}

absl::StatusOr<Cameras> OpenAll(const RobotFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(Cameras cameras, OpenCameras(flags.left, flags.right));
  for (const Side side : {Side::kLeft, Side::kRight}) {
    auto& camera = cameras[side == Side::kLeft ? 0 : 1];
    if (camera == nullptr) continue;
    HOMING_ASSIGN_OR_RETURN(camera, OpenWindow(std::move(camera), WindowOf(flags, side)));
  }
  return cameras;
}

void AddFrameChoice(CLI::App& command, FrameChoice& frames) {
  command.add_option("--every", frames.every, "Take every N-th frame")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000}))
      ->capture_default_str();
  command
      .add_option("--fps", frames.fps,
                  "Take at most this many frames a second, by the times of the source [all]")
      ->check(RealRange(1e-3, 1e4));
  command
      .add_option("--seconds", frames.seconds,
                  "End after this many seconds of the source [at its end]")
      ->check(RealRange(1e-3, 1e9));
  command.add_flag("--strict", frames.strict,
                   "End at a bad frame (empty, damaged, of another size) instead of skipping and "
                   "reporting it, and refuse frames of one camera without a partner of the other");
}

}  // namespace

absl::StatusOr<v1::Camera> ParseCamera(const std::string& text) {
  std::vector<std::string> parts = absl::StrSplit(text, ',');
  double yaw = 0;
  if (absl::StartsWith(parts.back(), "yaw=")) {
    if (!absl::SimpleAtod(parts.back().substr(4), &yaw)) return BadCamera(text);
    parts.pop_back();
  }
  std::vector<double> values;
  for (const std::string& part : parts) {
    double value = 0;
    if (absl::SimpleAtod(part, &value)) values.push_back(value);
  }
  v1::Camera camera;
  if (parts.size() == 1 && values.empty() && !parts[0].empty()) {
    HOMING_ASSIGN_OR_RETURN(const Camera calibrated, ReadCalibrationFile(parts[0]));
    camera = wire::ToProto(calibrated);
  } else if (values.size() == parts.size() && (values.size() == 4 || values.size() == 9)) {
    camera.set_focal_x(values[0]);
    camera.set_focal_y(values[1]);
    camera.set_center_x(values[2]);
    camera.set_center_y(values[3]);
    for (std::size_t i = 4; i < values.size(); ++i) camera.add_distortion(values[i]);
  } else {
    return BadCamera(text);
  }
  camera.set_yaw_rad(yaw);
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
      absl::StrCat("Calibrated camera, ", kCameraForm,
                   ": pixels and radians, or camera_info of ROS, kalibr or OpenCV");
  command
      .add_option(
          "--left", flags.left,
          "SOURCE of the robot's left camera: a folder or glob of images in natural order, "
          "a list of images with times (.txt, .csv), a video file, a camera /dev/videoN or N, an "
          "address rtsp://... or http://..., a bag FILE.mcap, FILE.bag or FILE.db3 with "
          "#TOPIC behind it where "
          "it has several, or sim:SCENE[,key=value...]")
      ->check(check_source);
  command.add_option("--right", flags.right, "SOURCE of the robot's right camera")
      ->check(check_source);
  command.add_option("--left-camera", flags.left_camera, camera_help)->check(check_camera);
  command.add_option("--right-camera", flags.right_camera, camera_help)->check(check_camera);
  const auto check_crop = [](const std::string& text) { return Explain(ParseCrop(text).status()); };
  command
      .add_option("--crop", flags.crop,
                  "X,Y,WIDTH,HEIGHT: the part of the images that is used, pixels [all]")
      ->check(check_crop);
  command.add_option("--right-crop", flags.right_crop, "The same of the right camera [--crop]")
      ->check(check_crop);
  command.add_option("--mask", flags.mask,
                     "Image of the size of the frames, before the crop; its white part is used: "
                     "leave out parts that move with the robot [all]");
  command.add_option("--right-mask", flags.right_mask, "The same of the right camera [--mask]");
  command.add_option("--send", flags.send, "Send the frames, or flow vectors computed here")
      ->check(CLI::IsMember({"frames", "flow"}))
      ->capture_default_str();
  AddFrameChoice(command, flags.frames);
}

absl::StatusOr<Cameras> OpenCameras(const RobotFlags& flags, const std::stop_token& stop) {
  // The thread may wait in the system for a pipe's writer or a camera, and outlive this call.
  std::packaged_task<absl::StatusOr<Cameras>()> open([flags] { return OpenAll(flags); });
  std::future<absl::StatusOr<Cameras>> opened = open.get_future();
  std::thread(std::move(open)).detach();
  while (opened.wait_for(kStopCheck) != std::future_status::ready) {
    if (stop.stop_requested()) return absl::CancelledError("stopped before the source was open");
  }
  return opened.get();
}

std::optional<v1::Camera> CameraOf(const RobotFlags& flags, const Cameras& cameras, Side side) {
  const bool left = side == Side::kLeft;
  if (!(left ? flags.left_camera : flags.right_camera).empty()) {
    v1::Camera given = left ? flags.left_intrinsics() : flags.right_intrinsics();
    const auto camera = wire::FromProto(given, left ? "left_camera" : "right_camera");
    // The server reports the error in it.
    if (!camera.ok()) return given;
    return wire::ToProto(CropCamera(*camera, WindowOf(flags, side)));
  }
  const auto& source = cameras[left ? 0 : 1];
  const auto camera = source == nullptr ? std::nullopt : source->camera();
  if (!camera) return std::nullopt;
  return wire::ToProto(*camera);
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
