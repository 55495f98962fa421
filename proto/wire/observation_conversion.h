// Converts observations, frames and flow fields between messages and homing types.
#ifndef PROTO_WIRE_OBSERVATION_CONVERSION_H_
#define PROTO_WIRE_OBSERVATION_CONVERSION_H_

#include <google/protobuf/timestamp.pb.h>

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "homing/flow/flow_vector.h"
#include "homing/flow/observation.h"
#include "homing/image/frame.h"
#include "homing/v1/types.pb.h"

namespace homing::wire {

// Limits on one message.
struct WireLimits {
  // Vectors of one camera at one instant.
  int max_vectors = 100'000;
  // Image side, pixels.
  int max_side_px = 8192;
};

// All FromProto: INVALID_ARGUMENT naming the field (under the path `field`), its value and the
// limit.

// Points into `message`, which must outlive the result. Raw encodings need a size. DecodeGray
// checks the length of the bytes and the image itself.
absl::StatusOr<Frame> FromProto(const v1::Frame& message, const std::string& field,
                                const WireLimits& limits = {});
// Refuses columns of unequal length, too many vectors, sizes outside 1 to max_side_px, and ends
// that are not finite or more than 65536 px from the origin.
absl::StatusOr<FlowField> FromProto(const v1::FlowVectors& message, const std::string& field,
                                    const WireLimits& limits = {});
// Frames point into `message`, which must outlive the result. At least one camera is required.
absl::StatusOr<Observation> FromProto(const v1::Observation& message,
                                      const WireLimits& limits = {});
// Nanoseconds since the epoch. 1970 to 2261.
absl::StatusOr<std::int64_t> FromProto(const google::protobuf::Timestamp& message,
                                       const std::string& field);

v1::Frame ToProto(const Frame& frame);
v1::FlowVectors ToProto(const FlowField& flow);
v1::Observation ToProto(const Observation& observation);
// `time_ns` is nanoseconds since the epoch, not negative.
google::protobuf::Timestamp TimestampToProto(std::int64_t time_ns);

}  // namespace homing::wire

#endif  // PROTO_WIRE_OBSERVATION_CONVERSION_H_
