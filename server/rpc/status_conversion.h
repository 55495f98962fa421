// The only place where absl::Status becomes grpc::Status. Source: own design.
#ifndef SERVER_RPC_STATUS_CONVERSION_H_
#define SERVER_RPC_STATUS_CONVERSION_H_

#include <google/protobuf/descriptor.h>
#include <grpcpp/support/status.h>

#include <functional>

#include "absl/status/status.h"

namespace homing::server {

// With google.rpc details: ErrorInfo always (domain "homing"), RetryInfo for RESOURCE_EXHAUSTED and
// UNAVAILABLE, BadRequest for INVALID_ARGUMENT (its field is a path in `request`, as FieldPath
// finds it). What INTERNAL and UNKNOWN say stays in the server's log. Messages are cut at 1000
// bytes.
grpc::Status ToGrpcStatus(const absl::Status& status,
                          const google::protobuf::Descriptor* request = nullptr);

// What `call` returns; INTERNAL or RESOURCE_EXHAUSTED (memory) for an exception.
absl::Status Guarded(const std::function<absl::Status()>& call);

absl::Status DrainingError();
absl::Status BusyError();
absl::Status IdleError();

}  // namespace homing::server

#endif  // SERVER_RPC_STATUS_CONVERSION_H_
