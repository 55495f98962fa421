#include "homing/journey/camera_pair.h"

namespace homing {

ObservedFlow Rectify(const ObservedFlow& flow, const std::array<Camera, 2>& cameras) {
  ObservedFlow rectified;
  rectified.makes_step = flow.makes_step;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (flow.fields[i]) {
      rectified.fields[i] = Rectify(*flow.fields[i], cameras[i]);
    }
  }
  return rectified;
}

}  // namespace homing
