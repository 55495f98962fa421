// Retries a stream after a broken link.
#ifndef CLIENT_RECONNECT_H_
#define CLIENT_RECONNECT_H_

#include <functional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "client/connection.h"

namespace homing::client {

// Receives messages for the user about the link.
using Log = std::function<void(const std::string&)>;

// Runs `attempt` until it succeeds or returns an error that a retry cannot cure. It sets its
// argument to true once it made more progress than all attempts before. Gives up with the last
// error after `retry_for` without progress, and after three OUT_OF_RANGE without progress.
// CANCELLED: stopped.
absl::Status Reconnecting(const Connection& connection, const std::stop_token& stop, const Log& log,
                          const std::function<absl::Status(bool* progress)>& attempt);

}  // namespace homing::client

#endif  // CLIENT_RECONNECT_H_
