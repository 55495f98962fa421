// Converts gRPC's status to absl's, with the server's retry delay.
#ifndef CLIENT_RPC_STATUS_H_
#define CLIENT_RPC_STATUS_H_

#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>

#include "absl/status/status.h"

namespace homing::client {

// Same code and message; keeps the delay of google.rpc.RetryInfo for RetryDelay. CANCELLED gets a
// delay of 0: a server that shuts down ends calls with it, and a client that cancelled its own call
// does not retry.
absl::Status FromGrpc(const grpc::Status& status);

// The delay that the server named, if any.
std::optional<std::chrono::milliseconds> RetryDelay(const absl::Status& status);

// True if the server, or the network on the way to it, reported `status` (FromGrpc made it), and
// not this machine.
bool IsFromServer(const absl::Status& status);

// True if something between client and server, such as a proxy, reset the stream.
bool IsReset(const absl::Status& status);

// The same call may succeed later: UNAVAILABLE, or RESOURCE_EXHAUSTED or CANCELLED with a delay.
bool IsRetriable(const absl::Status& status);

}  // namespace homing::client

#endif  // CLIENT_RPC_STATUS_H_
