// Tries a stream again after a broken link.
#ifndef CLIENT_RECONNECT_H_
#define CLIENT_RECONNECT_H_

#include <functional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "client/connection.h"

namespace homing::client {

// For people: what happens to the link.
using Log = std::function<void(const std::string&)>;

// Runs `attempt` until it ends well or with an error that another attempt cannot cure. It reports
// true through its argument once it got further than any attempt before. Gives up when the server
// was away for `retry_for` (its last error), and after three OUT_OF_RANGE without getting further.
// CANCELLED: stopped.
absl::Status Reconnecting(const Connection& connection, const std::stop_token& stop, const Log& log,
                          const std::function<absl::Status(bool* progress)>& attempt);

}  // namespace homing::client

#endif  // CLIENT_RECONNECT_H_
