#include "server/rpc/request_bytes.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "proto/wire/message_parts.h"
#include "server/base/error_reason.h"
#include "server/rpc/status_conversion.h"

namespace homing::server {
namespace {

// Requests have at most a few thousand parts.
constexpr int kMaxParts = 10'000;

absl::Status UndecodableError(const google::protobuf::Message& request) {
  return absl::InvalidArgumentError(
      absl::StrCat("a request cannot be decoded as ", request.GetTypeName(),
                   "; it is cut, of another type, or holds text that is not UTF-8"));
}

}  // namespace

absl::Status ParseRequest(grpc::ByteBuffer* bytes, google::protobuf::Message* request) {
  {
    grpc::ProtoBufferReader reader(bytes);
    const auto parts = wire::CountParts(*request->GetDescriptor(), &reader, kMaxParts);
    if (!parts) return UndecodableError(*request);
    if (*parts > kMaxParts) {
      return absl::InvalidArgumentError(absl::StrCat("a ", request->GetTypeName(),
                                                     " has more than ", kMaxParts,
                                                     " messages, texts and unknown fields"));
    }
  }
  grpc::ProtoBufferReader reader(bytes);
  return request->ParseFromZeroCopyStream(&reader) ? absl::OkStatus() : UndecodableError(*request);
}

absl::Status RequestMemoryError(std::int64_t most) {
  return WithReason(absl::ResourceExhaustedError(
                        absl::StrCat("the requests that wait, yours or all together, need more "
                                     "than their part of memory-quota, ",
                                     most, " bytes")),
                    {"REQUEST_MEMORY", {}});
}

absl::Status RequestTimeError() {
  return WithReason(
      absl::DeadlineExceededError(absl::StrCat("no request came for ", kRequestTime.count(), " s")),
      {"REQUEST_TIME", {}});
}

absl::Status ParseOnlyRequest(bool arrived, const Cancellation& call, grpc::ByteBuffer* bytes,
                              google::protobuf::Message* request) {
  if (!arrived) {
    HOMING_RETURN_IF_ERROR(CheckAwaited(&call));
    return absl::InvalidArgumentError("the call has no request");
  }
  return Guarded([&] { return ParseRequest(bytes, request); });
}

}  // namespace homing::server
