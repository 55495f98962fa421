// ROS 1 bags, version 2.0. Source: the format's public description (wiki.ros.org/Bags/Format/2.0).
#ifndef CLIENT_BAG_ROS1_BAG_H_
#define CLIENT_BAG_ROS1_BAG_H_

#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "client/bag/bag_file.h"

namespace homing::client::bag {

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

// REQUIRES: the file begins with kRos1Magic.
absl::StatusOr<std::unique_ptr<Bag>> OpenRos1Bag(BagFile file, const BagLimits& limits);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_ROS1_BAG_H_
