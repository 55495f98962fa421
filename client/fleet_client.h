// The live state of the robots.
#ifndef CLIENT_FLEET_CLIENT_H_
#define CLIENT_FLEET_CLIENT_H_

#include <functional>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/connection.h"
#include "homing/v1/fleet_service.pb.h"

namespace homing::client {

// All robots that the caller may see, in order of name.
absl::StatusOr<std::vector<v1::Robot>> ListRobots(const Connection& connection,
                                                  const std::stop_token& stop);

// Calls `changed` with all robots, then with those that changed, until it fails or the server ends
// the stream. CANCELLED: stopped.
absl::Status WatchFleet(const Connection& connection, const std::stop_token& stop,
                        const std::function<absl::Status(const v1::WatchFleetResponse&)>& changed);

}  // namespace homing::client

#endif  // CLIENT_FLEET_CLIENT_H_
