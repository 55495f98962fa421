// Counts what takes more memory in a message than in its bytes, before it is parsed.
#ifndef PROTO_WIRE_MESSAGE_PARTS_H_
#define PROTO_WIRE_MESSAGE_PARTS_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

#include <optional>

namespace homing::wire {

// The submessages, repeated texts and unknown fields in the bytes of a message of type `type`. Each
// has two bytes at least, and needs a hundred in memory. Counting ends at `most` + 1. std::nullopt:
// the bytes are no such message. Allocates nothing.
std::optional<int> CountParts(const google::protobuf::Descriptor& type,
                              google::protobuf::io::ZeroCopyInputStream* bytes, int most);

}  // namespace homing::wire

#endif  // PROTO_WIRE_MESSAGE_PARTS_H_
