// Files in which robots record messages (bags): topics, and the bytes of their messages.
#ifndef CLIENT_BAG_BAG_H_
#define CLIENT_BAG_BAG_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace homing::client::bag {

enum class Wire { kOther, kRos1, kCdr, kProtobuf };

enum class Content { kOther, kRawImage, kCompressedImage, kCameraInfo };

// The place of a message in the file, in the terms of its format.
struct MessagePlace {
  // Nanoseconds; when it was recorded.
  std::int64_t time_ns = 0;
  // Offset of its chunk in the file; -1: it is in no chunk.
  std::int64_t chunk = -1;
  std::int64_t offset = 0;
  std::uint32_t channel = 0;
};

struct BagTopic {
  std::string name;
  // As the bag has it: "sensor_msgs/msg/Image".
  std::string type;
  Wire wire = Wire::kOther;
  Content content = Content::kOther;
  // In the order of their times. Empty for kOther.
  std::vector<MessagePlace> messages;
};

struct BagLimits {
  // Largest decompressed size of one chunk or message, bytes.
  std::uint64_t max_chunk = std::uint64_t{256} << 20;
};

// Not thread-safe.
class Bag {
 public:
  virtual ~Bag() = default;
  // In the order of their names.
  const std::vector<BagTopic>& topics() const { return topics_; }
  // One line that describes the unreadable part of the file; empty: all was read.
  const std::string& damage() const { return damage_; }
  // A message of topics(). DATA_LOSS: damaged.
  virtual absl::StatusOr<std::string> Read(const MessagePlace& place) = 0;

 protected:
  // The topic's index in topics_; adds the topic if it is new.
  std::size_t AddTopic(const std::string& name, const std::string& type, Wire wire);
  // Only the first report is kept.
  void ReportDamage(const std::string& what);
  // Call it at the end of opening.
  void SortTopics();

  std::vector<BagTopic> topics_;

 private:
  std::string damage_;
};

// The content of a topic of this type, by the names of ROS 1, ROS 2 and Foxglove.
Content ContentOf(const std::string& type, Wire wire);

// An MCAP file, a ROS 1 bag or a database of rosbag2, by its first bytes. A file that ends too
// early or has damaged parts is opened; damage() says so. NOT_FOUND, PERMISSION_DENIED;
// INVALID_ARGUMENT: none of the three.
absl::StatusOr<std::unique_ptr<Bag>> OpenBag(const std::string& path, const BagLimits& limits = {});

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_BAG_H_
