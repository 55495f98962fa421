#include "client/bag/image_message.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/bag/foxglove.pb.h"
#include "client/bag/raw_image.h"
#include "client/bag/ros_reader.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

absl::Status Short(const BagTopic& topic) {
  return absl::DataLossError(absl::StrCat("the message is not a complete ", topic.type));
}

absl::StatusOr<SourceFrame> Compressed(std::string_view data, std::string_view format) {
  SourceFrame frame;
  frame.data = std::string(data);
  if (absl::StartsWith(frame.data, "\xff\xd8")) {
    frame.encoding = FrameEncoding::kJpeg;
  } else if (absl::StartsWith(frame.data, "\x89PNG")) {
    frame.encoding = FrameEncoding::kPng;
  } else {
    return absl::InvalidArgumentError(
        absl::StrCat("the image's format \"", std::string(format), "\" is neither JPEG nor PNG"));
  }
  return frame;
}

template <typename Message>
absl::StatusOr<Message> Parse(const BagTopic& topic, std::string_view bytes) {
  Message message;
  if (bytes.size() > std::size_t{std::numeric_limits<int>::max()} ||
      !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return Short(topic);
  }
  return message;
}

std::int64_t Nanoseconds(const google::protobuf::Timestamp& time) {
  // Times that do not fit into 64 bits count as absent.
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (time.seconds() < 0 ||
      time.seconds() > std::numeric_limits<std::int64_t>::max() / kSecond - 1) {
    return 0;
  }
  return time.seconds() * kSecond + time.nanos();
}

absl::StatusOr<SourceFrame> RosImage(const BagTopic& topic, RosReader reader) {
  const std::int64_t stamp = reader.Header();
  RawImage image;
  image.height = reader.Take<std::uint32_t>();
  image.width = reader.Take<std::uint32_t>();
  image.encoding = reader.Text();
  image.big_endian = reader.Take<std::uint8_t>() != 0;
  image.step = reader.Take<std::uint32_t>();
  image.data = reader.Bytes();
  if (!reader.ok()) return Short(topic);
  HOMING_ASSIGN_OR_RETURN(SourceFrame frame, ConvertRawImage(image));
  frame.capture_time_ns = stamp;
  return frame;
}

absl::StatusOr<SourceFrame> RosCompressedImage(const BagTopic& topic, RosReader reader) {
  const std::int64_t stamp = reader.Header();
  const std::string_view format = reader.Text();
  const std::string_view data = reader.Bytes();
  if (!reader.ok()) return Short(topic);
  HOMING_ASSIGN_OR_RETURN(SourceFrame frame, Compressed(data, format));
  frame.capture_time_ns = stamp;
  return frame;
}

absl::StatusOr<SourceFrame> FoxgloveImage(const BagTopic& topic, std::string_view bytes) {
  HOMING_ASSIGN_OR_RETURN(const auto message, Parse<foxglove::RawImage>(topic, bytes));
  RawImage image;
  image.width = message.width();
  image.height = message.height();
  image.step = message.step();
  image.encoding = message.encoding();
  image.data = message.data();
  HOMING_ASSIGN_OR_RETURN(SourceFrame frame, ConvertRawImage(image));
  frame.capture_time_ns = Nanoseconds(message.timestamp());
  return frame;
}

absl::StatusOr<SourceFrame> FoxgloveCompressedImage(const BagTopic& topic, std::string_view bytes) {
  HOMING_ASSIGN_OR_RETURN(const auto message, Parse<foxglove::CompressedImage>(topic, bytes));
  HOMING_ASSIGN_OR_RETURN(SourceFrame frame, Compressed(message.data(), message.format()));
  frame.capture_time_ns = Nanoseconds(message.timestamp());
  return frame;
}

// K and P describe the whole sensor. The images may show a part of it, with several of its pixels
// in one (sensor_msgs/CameraInfo, binning and roi). A message that ends here shows all of it.
void FitToImages(RosReader* reader, CameraInfo* info) {
  const auto binning_x = std::max<std::uint32_t>(1, reader->Take<std::uint32_t>());
  const auto binning_y = std::max<std::uint32_t>(1, reader->Take<std::uint32_t>());
  const auto left = reader->Take<std::uint32_t>();
  const auto top = reader->Take<std::uint32_t>();
  const auto height = reader->Take<std::uint32_t>();
  const auto width = reader->Take<std::uint32_t>();
  info->width = (width > 0 ? width : info->width) / binning_x;
  info->height = (height > 0 ? height : info->height) / binning_y;
  for (std::vector<double>* values : {&info->matrix, &info->projection}) {
    const std::size_t columns = values->size() / 3;
    // All zeros mean that the camera is not calibrated.
    if ((*values)[0] == 0) continue;
    (*values)[0] /= binning_x;
    (*values)[2] = ((*values)[2] - left) / binning_x;
    (*values)[columns + 1] /= binning_y;
    (*values)[columns + 2] = ((*values)[columns + 2] - top) / binning_y;
  }
}

absl::StatusOr<CameraInfo> FoxgloveCamera(const BagTopic& topic, std::string_view bytes) {
  HOMING_ASSIGN_OR_RETURN(const auto message, Parse<foxglove::CameraCalibration>(topic, bytes));
  CameraInfo info;
  info.width = message.width();
  info.height = message.height();
  info.distortion_model = message.distortion_model();
  info.distortion.assign(message.d().begin(), message.d().end());
  info.matrix.assign(message.k().begin(), message.k().end());
  info.projection.assign(message.p().begin(), message.p().end());
  return info;
}

}  // namespace

absl::StatusOr<SourceFrame> DecodeImage(const BagTopic& topic, std::string_view bytes) {
  const bool raw = topic.content == Content::kRawImage;
  if (topic.wire == Wire::kProtobuf) {
    return raw ? FoxgloveImage(topic, bytes) : FoxgloveCompressedImage(topic, bytes);
  }
  const RosReader reader(topic.wire, bytes);
  return raw ? RosImage(topic, reader) : RosCompressedImage(topic, reader);
}

std::int64_t StampOf(const BagTopic& topic, std::string_view bytes) {
  if (topic.wire != Wire::kProtobuf) {
    RosReader reader(topic.wire, bytes);
    const std::int64_t stamp = reader.Header();
    return reader.ok() ? stamp : 0;
  }
  // Both image types have the timestamp in the same field.
  const auto message = Parse<foxglove::CompressedImage>(topic, bytes);
  return message.ok() ? Nanoseconds(message->timestamp()) : 0;
}

absl::StatusOr<CameraInfo> DecodeCameraInfo(const BagTopic& topic, std::string_view bytes) {
  if (topic.wire == Wire::kProtobuf) return FoxgloveCamera(topic, bytes);
  RosReader reader(topic.wire, bytes);
  reader.Header();
  CameraInfo info;
  info.height = reader.Take<std::uint32_t>();
  info.width = reader.Take<std::uint32_t>();
  info.distortion_model = std::string(reader.Text());
  info.distortion = reader.Doubles(reader.Take<std::uint32_t>());
  info.matrix = reader.Doubles(9);
  // Skips the rectification matrix.
  reader.Doubles(9);
  info.projection = reader.Doubles(12);
  if (!reader.ok()) return Short(topic);
  FitToImages(&reader, &info);
  return info;
}

}  // namespace homing::client::bag
