#include "homing/journey/see_landmarks.h"

#include "homing/flow/camera.h"

namespace homing {
namespace {

ObservedFlow RectifyBoth(const ObservedFlow& raw, const std::array<Camera, 2>& cameras) {
  ObservedFlow rectified;
  rectified.makes_step = raw.makes_step;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (raw.fields[i]) {
      rectified.fields[i] = Rectify(*raw.fields[i], cameras[i]);
    }
  }
  return rectified;
}

}  // namespace

Side RouteSide(Side camera, Travel travel) {
  if (travel == Travel::kSame) {
    return camera;
  }
  return camera == Side::kLeft ? Side::kRight : Side::kLeft;
}

SeenStep SeeLandmarks(const ObservedFlow& raw, const std::array<Camera, 2>& cameras, Travel travel,
                      const LandmarkOptions& options) {
  SeenStep seen;
  // Added to the paper: the flow that ideal cameras, square to the direction of travel, would see.
  seen.flow = RectifyBoth(raw, cameras);
  seen.motion = ClassifyMotion(seen.flow, cameras);
  if (seen.motion != Motion::kMoving) {
    return seen;
  }
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    // III, Fig. 4, equations (11), (12): at most two landmarks a camera.
    if (const auto& field = seen.flow.fields[static_cast<std::size_t>(camera)]) {
      seen.landmarks[static_cast<std::size_t>(RouteSide(camera, travel))] =
          FindLandmarks(*field, options);
    }
  }
  return seen;
}

}  // namespace homing
