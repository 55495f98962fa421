// Chooses the topics of a camera in a bag.
#ifndef CLIENT_BAG_TOPIC_CHOICE_H_
#define CLIENT_BAG_TOPIC_CHOICE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "homing/flow/observation.h"

namespace homing::client::bag {

// The image topic `name`; if that is empty, the only image topic, or the only one that has left or
// right in its name as `camera` says. An image's compressed twin is not counted. INVALID_ARGUMENT:
// there is none, or more than one; the message lists the image topics with counts and rates.
absl::StatusOr<const BagTopic*> ChooseImageTopic(const std::vector<BagTopic>& topics,
                                                 const std::string& name, Side camera);

// The camera_info topic beside an image topic, else nullptr.
const BagTopic* FindCameraInfo(const std::vector<BagTopic>& topics, const BagTopic& image);

// True for images without distortion, by the names in ROS: image_rect, image_rect_color.
bool IsRectified(const BagTopic& image);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_TOPIC_CHOICE_H_
