// gRPC's status to absl's, with the server's advice on when to try again. Source: own design.
#ifndef CLIENT_RPC_STATUS_H_
#define CLIENT_RPC_STATUS_H_

#include <grpcpp/support/status.h>

#include <chrono>
#include <optional>

#include "absl/status/status.h"

namespace homing::client {

// Same code and message; keeps the delay of google.rpc.RetryInfo for RetryDelay. CANCELLED, by
// which a server that shuts down ends calls, has a delay of 0: who cancels a call of its own does
// not ask.
absl::Status FromGrpc(const grpc::Status& status);

// The delay that the server named, if it did.
std::optional<std::chrono::milliseconds> RetryDelay(const absl::Status& status);

// Whether the server (or the way to it) said so, and not this machine: FromGrpc made it.
bool IsFromServer(const absl::Status& status);

// Whether something between client and server, as a proxy, broke the stream off.
bool IsReset(const absl::Status& status);

// Whether the same call may succeed later: UNAVAILABLE, and RESOURCE_EXHAUSTED or CANCELLED with a
// delay.
bool IsRetriable(const absl::Status& status);

}  // namespace homing::client

#endif  // CLIENT_RPC_STATUS_H_
