// The only place where absl::Status becomes grpc::Status.
#ifndef SERVER_RPC_STATUS_CONVERSION_H_
#define SERVER_RPC_STATUS_CONVERSION_H_

#include <grpcpp/support/status.h>

#include <functional>

#include "absl/status/status.h"

namespace homing::server {

// Adds google.rpc details: ErrorInfo always (domain "homing"), RetryInfo for RESOURCE_EXHAUSTED and
// UNAVAILABLE, BadRequest for INVALID_ARGUMENT (with the field of homing::FieldError). The messages
// of INTERNAL and UNKNOWN go to the server's log only. Messages are cut at 1000 bytes.
grpc::Status ToGrpcStatus(const absl::Status& status);

// The result of `call`; INTERNAL or RESOURCE_EXHAUSTED (memory) if it throws.
absl::Status Guarded(const std::function<absl::Status()>& call);

absl::Status DrainingError();
absl::Status BusyError();
absl::Status IdleError();

}  // namespace homing::server

#endif  // SERVER_RPC_STATUS_CONVERSION_H_
