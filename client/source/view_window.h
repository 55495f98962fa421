// The used part of a camera's images: without the robot's own bonnet, arm or timestamp, which never
// move in the image.
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
  // An image file of the size of the whole images; pixels brighter than half are used. Empty: all
  // are used.
  std::string mask;

  bool whole() const { return !crop && mask.empty(); }
};

// The same camera for the part: its image begins at the rectangle's corner.
Camera CropCamera(Camera camera, const ViewWindow& window);

// Grey frames of `source`, cropped. Masked parts fade into the mean of their surroundings, so that
// neither they nor their edges can be tracked. NOT_FOUND, INVALID_ARGUMENT: the mask cannot be
// read. Frames of a size that does not fit have a fault.
absl::StatusOr<std::unique_ptr<FrameSource>> OpenWindow(std::unique_ptr<FrameSource> source,
                                                        const ViewWindow& window);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_VIEW_WINDOW_H_
