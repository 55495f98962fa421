// Flags of several commands.
#ifndef CLIENT_COMMAND_FLAGS_H_
#define CLIENT_COMMAND_FLAGS_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/camera_observations.h"
#include "client/connection.h"
#include "client/journey_client.h"
#include "client/source/camera_instants.h"
#include "homing/flow/flow_tracker.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/types.pb.h"

namespace homing::client {

// "fx,fy,cx,cy[,k1,k2,p1,p2,k3][,yaw=RAD]", pixels and radians, or "FILE[#CAMERA][,yaw=RAD]", see
// client/calibration_file.h. INVALID_ARGUMENT, NOT_FOUND.
absl::StatusOr<v1::Camera> ParseCamera(const std::string& text);

// --left, --right, --left-camera, --right-camera, --send, --every, --fps, --seconds, --strict.
struct RobotFlags {
  std::string left;
  std::string right;
  std::string left_camera;
  std::string right_camera;
  // X,Y,WIDTH,HEIGHT and image files; those of the right camera are the left one's unless given.
  std::string crop;
  std::string right_crop;
  std::string mask;
  std::string right_mask;
  std::string send = "frames";
  FrameChoice frames;

  bool sends_flow() const { return send == "flow"; }
  // The given cameras. REQUIRES: the flags were checked.
  v1::Camera left_intrinsics() const;
  v1::Camera right_intrinsics() const;
};

// The sources that the flags name, each as its crop and mask leave it. As OpenFrameSource;
// CANCELLED: stopped while a source did not open, such as a pipe that no program writes to.
absl::StatusOr<Cameras> OpenCameras(const RobotFlags& flags, const std::stop_token& stop);

void AddRobotFlags(CLI::App& command, RobotFlags& flags);
// The camera of a side: as the flags give it, else as the source describes it, else nothing.
std::optional<v1::Camera> CameraOf(const RobotFlags& flags, const Cameras& cameras, Side side);
// Throws CLI's error of usage unless --left or --right is given.
void RequireCamera(const RobotFlags& flags);

// --journey NAME; wildcards only if `wildcards`.
CLI::Option* AddJourneyFlag(CLI::App& command, std::string& journey, bool wildcards);

// --travel return|same.
void AddTravelFlag(CLI::App& command, std::string& travel);
v1::Travel ToTravel(const std::string& travel);

// The settings for the flow of a journey; for a wildcard those of its first journey.
absl::StatusOr<FlowOptions> FlowOptionsOf(JourneyClient& journeys, const std::string& journey);

// --writer's default: this machine's id, else its name.
std::string DefaultWriter();

}  // namespace homing::client

#endif  // CLIENT_COMMAND_FLAGS_H_
