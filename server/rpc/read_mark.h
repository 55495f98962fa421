// Distinguishes a message that cannot be decoded from the end of a stream: gRPC reports both alike.
#ifndef SERVER_RPC_READ_MARK_H_
#define SERVER_RPC_READ_MARK_H_

#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace homing::server {

// Call it before a read. Decoding first clears the message, and with it the mark.
inline void MarkUnread(google::protobuf::Message* message) {
  constexpr int kAnyNumber = 1000;
  message->GetReflection()->MutableUnknownFields(message)->AddVarint(kAnyNumber, 1);
}

// Call it after a failed read. True: bytes arrived and could not be decoded.
inline bool IsUndecodable(const google::protobuf::Message& message) {
  return message.GetReflection()->GetUnknownFields(message).empty();
}

inline absl::Status UndecodableError(const google::protobuf::Message& message) {
  return absl::InvalidArgumentError(
      absl::StrCat("a message of the stream cannot be decoded as ", message.GetTypeName(),
                   "; it is cut, of another type, or holds text that is not UTF-8"));
}

}  // namespace homing::server

#endif  // SERVER_RPC_READ_MARK_H_
