// Messages with images and cameras, by ROS 1, ROS 2 (CDR) and Foxglove (Protobuf). Source:
// sensor_msgs, docs.foxglove.dev.
#ifndef CLIENT_BAG_IMAGE_MESSAGE_H_
#define CLIENT_BAG_IMAGE_MESSAGE_H_

#include <cstdint>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "client/bag/camera_info.h"
#include "client/source/frame_source.h"

namespace homing::client::bag {

// An image of a topic whose content is kRawImage or kCompressedImage; JPEG and PNG stay as they
// are. capture_time_ns is the message's stamp, 0 if it has none. INVALID_ARGUMENT, DATA_LOSS.
absl::StatusOr<SourceFrame> DecodeImage(const BagTopic& topic, std::string_view bytes);

// The stamp of such a message, nanoseconds; 0: it has none, or is damaged.
std::int64_t StampOf(const BagTopic& topic, std::string_view bytes);

// A message of a topic whose content is kCameraInfo: the camera of the images, which may be binned
// or show a part of the sensor. INVALID_ARGUMENT, DATA_LOSS.
absl::StatusOr<CameraInfo> DecodeCameraInfo(const BagTopic& topic, std::string_view bytes);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_IMAGE_MESSAGE_H_
