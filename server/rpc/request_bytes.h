// Parses the requests of clients.
#ifndef SERVER_RPC_REQUEST_BYTES_H_
#define SERVER_RPC_REQUEST_BYTES_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include <chrono>
#include <cstdint>

#include "absl/status/status.h"
#include "homing/base/cancellation.h"

namespace homing::server {

// Fills `request` from `bytes`. INVALID_ARGUMENT: they are no such message, or one that would take
// many times as much memory.
absl::Status ParseRequest(grpc::ByteBuffer* bytes, google::protobuf::Message* request);

// RESOURCE_EXHAUSTED: the requests that wait for a worker need more than `most` bytes, or those of
// the caller more than its part.
absl::Status RequestMemoryError(std::int64_t most);

// Time for the request of a call that has only one: on a slow link the largest takes as long.
inline constexpr std::chrono::seconds kRequestTime{60};
absl::Status RequestTimeError();

// As ParseRequest, for that request. CANCELLED or INVALID_ARGUMENT: none `arrived`.
absl::Status ParseOnlyRequest(bool arrived, const Cancellation& call, grpc::ByteBuffer* bytes,
                              google::protobuf::Message* request);

}  // namespace homing::server

#endif  // SERVER_RPC_REQUEST_BYTES_H_
