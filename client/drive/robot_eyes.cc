#include "client/drive/robot_eyes.h"

namespace homing::client {

Observation RenderedEyes::See(const Pose& robot, std::int64_t frame) {
  Observation seen;
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const auto at = static_cast<std::size_t>(camera);
    cv::Mat& image = images_[at];
    image = cameras_->Render(robot, frame, camera);
    seen.views[at] = Frame{FrameEncoding::kGray8,
                           image.cols,
                           image.rows,
                           {reinterpret_cast<const char*>(image.data), image.total()}};
  }
  return seen;
}

}  // namespace homing::client
