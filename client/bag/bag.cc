#include "client/bag/bag.h"

#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/bag/bag_file.h"
#include "client/bag/mcap_format.h"
#include "client/bag/mcap_reader.h"
#include "client/bag/ros1_bag.h"
#include "client/bag/rosbag2_database.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

struct KnownType {
  const char* name;
  Content content;
};

constexpr std::array<KnownType, 3> kRosTypes = {{
    {"Image", Content::kRawImage},
    {"CompressedImage", Content::kCompressedImage},
    {"CameraInfo", Content::kCameraInfo},
}};
constexpr std::array<KnownType, 3> kFoxgloveTypes = {{
    {"foxglove.RawImage", Content::kRawImage},
    {"foxglove.CompressedImage", Content::kCompressedImage},
    {"foxglove.CameraCalibration", Content::kCameraInfo},
}};

}  // namespace

Content ContentOf(const std::string& type, Wire wire) {
  if (wire == Wire::kOther) return Content::kOther;
  const bool protobuf = wire == Wire::kProtobuf;
  const std::string folder = wire == Wire::kCdr ? "sensor_msgs/msg/" : "sensor_msgs/";
  for (const KnownType& known : protobuf ? kFoxgloveTypes : kRosTypes) {
    if (type == (protobuf ? known.name : folder + known.name)) return known.content;
  }
  return Content::kOther;
}

std::size_t Bag::AddTopic(const std::string& name, const std::string& type, Wire wire) {
  const auto same = [&](const BagTopic& topic) {
    return topic.name == name && topic.type == type && topic.wire == wire;
  };
  const auto found = std::find_if(topics_.begin(), topics_.end(), same);
  const auto index = static_cast<std::size_t>(found - topics_.begin());
  if (found == topics_.end()) topics_.push_back({name, type, wire, ContentOf(type, wire), {}});
  return index;
}

void Bag::ReportDamage(const std::string& what) {
  if (damage_.empty()) damage_ = what;
}

void Bag::SortTopics() {
  std::sort(topics_.begin(), topics_.end(), [](const BagTopic& a, const BagTopic& b) {
    return std::tie(a.name, a.type) < std::tie(b.name, b.type);
  });
  for (BagTopic& topic : topics_) {
    std::stable_sort(
        topic.messages.begin(), topic.messages.end(),
        [](const MessagePlace& a, const MessagePlace& b) { return a.time_ns < b.time_ns; });
  }
}

absl::StatusOr<std::unique_ptr<Bag>> OpenBag(const std::string& path, const BagLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(BagFile file, BagFile::Open(path));
  HOMING_ASSIGN_OR_RETURN(const std::string head, file.ReadUpTo(0, 16));
  if (head.starts_with(kMcapMagic)) return OpenMcap(std::move(file), limits);
  if (head.starts_with(kRos1Magic)) return OpenRos1Bag(std::move(file), limits);
  if (absl::StartsWith(head, "SQLite format 3")) return OpenRosbag2Database(path, limits);
  if (absl::StartsWith(head, "#ROSBAG V")) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is a ROS 1 bag of an old version; only 2.0 is read"));
  }
  if (head.empty()) return absl::InvalidArgumentError(absl::StrCat(path, " is empty"));
  return absl::InvalidArgumentError(absl::StrCat(
      path, " is neither an MCAP file nor a ROS 1 bag nor a database of rosbag2",
      absl::StartsWith(head, "\x28\xb5\x2f\xfd") ? "; decompress it with zstd -d first" : ""));
}

}  // namespace homing::client::bag
