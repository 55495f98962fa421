// Converts enumerations and fingerprints between messages and homing types.
#ifndef PROTO_WIRE_ENUM_CONVERSION_H_
#define PROTO_WIRE_ENUM_CONVERSION_H_

#include <string>

#include "absl/status/statusor.h"
#include "homing/flow/motion.h"
#include "homing/flow/observation.h"
#include "homing/image/frame.h"
#include "homing/landmark/fingerprint.h"
#include "homing/localization/position_filter.h"
#include "homing/matching/matcher.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/types.pb.h"

namespace homing::wire {

v1::Side ToProto(Side side);
v1::Motion ToProto(Motion motion);
v1::Travel ToProto(Travel travel);
v1::Outcome ToProto(Outcome outcome);
v1::Direction ToProto(Direction direction);
v1::FrameEncoding ToProto(FrameEncoding encoding);
v1::Fingerprint ToProto(Side side, const Fingerprint& fingerprint);

// INVALID_ARGUMENT naming `field` for an unspecified or unknown value; but an unspecified travel is
// kReturn and an unspecified direction kUnknown.
absl::StatusOr<Side> FromProto(v1::Side side, const std::string& field);
absl::StatusOr<Motion> FromProto(v1::Motion motion, const std::string& field);
absl::StatusOr<Travel> FromProto(v1::Travel travel, const std::string& field);
absl::StatusOr<Outcome> FromProto(v1::Outcome outcome, const std::string& field);
absl::StatusOr<Direction> FromProto(v1::Direction direction, const std::string& field);
absl::StatusOr<FrameEncoding> FromProto(v1::FrameEncoding encoding, const std::string& field);

}  // namespace homing::wire

#endif  // PROTO_WIRE_ENUM_CONVERSION_H_
