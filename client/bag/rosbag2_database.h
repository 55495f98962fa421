// Databases of rosbag2 (.db3). Source: the tables that rosbag2 writes.
#ifndef CLIENT_BAG_ROSBAG2_DATABASE_H_
#define CLIENT_BAG_ROSBAG2_DATABASE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"

namespace homing::client::bag {

// Opens it for reading only. INVALID_ARGUMENT: no SQLite file, or without the tables.
absl::StatusOr<std::unique_ptr<Bag>> OpenRosbag2Database(const std::string& path,
                                                         const BagLimits& limits);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_ROSBAG2_DATABASE_H_
