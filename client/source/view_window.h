// The part of a camera's images that is used: without the robot's own bonnet, arm or timestamp,
// which would be taken for things that do not move.
#ifndef CLIENT_SOURCE_VIEW_WINDOW_H_
#define CLIENT_SOURCE_VIEW_WINDOW_H_

#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client {

// Pixels of the whole image.
struct CropRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

// "X,Y,WIDTH,HEIGHT". INVALID_ARGUMENT.
absl::StatusOr<CropRectangle> ParseCrop(const std::string& text);

struct ViewWindow {
  std::optional<CropRectangle> crop;
  // An image file of the size of the whole images; what is brighter than half is used. Empty: all.
  std::string mask;

  bool whole() const { return !crop && mask.empty(); }
};

// The same camera for the part: its image begins at the rectangle's corner.
Camera CropCamera(Camera camera, const ViewWindow& window);

// Grey frames of `source`, cropped. What the mask leaves out fades into the mean around it, so that
// neither it nor its edge has anything to follow. NOT_FOUND, INVALID_ARGUMENT: the mask cannot be
// read. Frames of a size that does not fit have a fault.
absl::StatusOr<std::unique_ptr<FrameSource>> OpenWindow(std::unique_ptr<FrameSource> source,
                                                        const ViewWindow& window);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_VIEW_WINDOW_H_
