#include "proto/wire/enum_conversion.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"

namespace homing::wire {
namespace {

absl::Status UnknownValue(const std::string& field, int value, const char* allowed) {
  return MustBe(field, value, allowed);
}

}  // namespace

v1::Side ToProto(Side side) { return side == Side::kLeft ? v1::SIDE_LEFT : v1::SIDE_RIGHT; }

v1::Motion ToProto(Motion motion) {
  switch (motion) {
    case Motion::kMoving:
      return v1::MOTION_MOVING;
    case Motion::kStanding:
      return v1::MOTION_STANDING;
    case Motion::kTurning:
      return v1::MOTION_TURNING;
  }
  return v1::MOTION_UNSPECIFIED;
}

v1::Travel ToProto(Travel travel) {
  return travel == Travel::kReturn ? v1::TRAVEL_RETURN : v1::TRAVEL_SAME;
}

v1::Outcome ToProto(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMatch:
      return v1::OUTCOME_MATCH;
    case Outcome::kAmbiguous:
      return v1::OUTCOME_AMBIGUOUS;
    case Outcome::kUnknownPlace:
      return v1::OUTCOME_UNKNOWN_PLACE;
  }
  return v1::OUTCOME_UNSPECIFIED;
}

v1::Direction ToProto(Direction direction) {
  switch (direction) {
    case Direction::kUnknown:
      return v1::DIRECTION_UNSPECIFIED;
    case Direction::kHomeward:
      return v1::DIRECTION_HOMEWARD;
    case Direction::kOutward:
      return v1::DIRECTION_OUTWARD;
  }
  return v1::DIRECTION_UNSPECIFIED;
}

v1::FrameEncoding ToProto(FrameEncoding encoding) {
  switch (encoding) {
    case FrameEncoding::kGray8:
      return v1::FRAME_ENCODING_GRAY8;
    case FrameEncoding::kRgb8:
      return v1::FRAME_ENCODING_RGB8;
    case FrameEncoding::kBgr8:
      return v1::FRAME_ENCODING_BGR8;
    case FrameEncoding::kJpeg:
      return v1::FRAME_ENCODING_JPEG;
    case FrameEncoding::kPng:
      return v1::FRAME_ENCODING_PNG;
  }
  return v1::FRAME_ENCODING_UNSPECIFIED;
}

v1::Fingerprint ToProto(Side side, const Fingerprint& fingerprint) {
  v1::Fingerprint message;
  message.set_landmark(fingerprint.landmark);
  message.set_side(ToProto(side));
  message.set_x(fingerprint.x);
  message.set_y(fingerprint.y);
  message.set_count(fingerprint.count);
  return message;
}

absl::StatusOr<Side> FromProto(v1::Side side, const std::string& field) {
  switch (side) {
    case v1::SIDE_LEFT:
      return Side::kLeft;
    case v1::SIDE_RIGHT:
      return Side::kRight;
    default:
      return UnknownValue(field, side, "SIDE_LEFT or SIDE_RIGHT");
  }
}

absl::StatusOr<Motion> FromProto(v1::Motion motion, const std::string& field) {
  switch (motion) {
    case v1::MOTION_MOVING:
      return Motion::kMoving;
    case v1::MOTION_STANDING:
      return Motion::kStanding;
    case v1::MOTION_TURNING:
      return Motion::kTurning;
    default:
      return UnknownValue(field, motion, "MOTION_MOVING, MOTION_STANDING or MOTION_TURNING");
  }
}

absl::StatusOr<Travel> FromProto(v1::Travel travel, const std::string& field) {
  switch (travel) {
    case v1::TRAVEL_UNSPECIFIED:
    case v1::TRAVEL_RETURN:
      return Travel::kReturn;
    case v1::TRAVEL_SAME:
      return Travel::kSame;
    default:
      return UnknownValue(field, travel, "TRAVEL_RETURN or TRAVEL_SAME");
  }
}

absl::StatusOr<Outcome> FromProto(v1::Outcome outcome, const std::string& field) {
  switch (outcome) {
    case v1::OUTCOME_MATCH:
      return Outcome::kMatch;
    case v1::OUTCOME_AMBIGUOUS:
      return Outcome::kAmbiguous;
    case v1::OUTCOME_UNKNOWN_PLACE:
      return Outcome::kUnknownPlace;
    default:
      return UnknownValue(field, outcome,
                          "OUTCOME_MATCH, OUTCOME_AMBIGUOUS or OUTCOME_UNKNOWN_PLACE");
  }
}

absl::StatusOr<Direction> FromProto(v1::Direction direction, const std::string& field) {
  switch (direction) {
    case v1::DIRECTION_UNSPECIFIED:
      return Direction::kUnknown;
    case v1::DIRECTION_HOMEWARD:
      return Direction::kHomeward;
    case v1::DIRECTION_OUTWARD:
      return Direction::kOutward;
    default:
      return UnknownValue(field, direction, "DIRECTION_HOMEWARD or DIRECTION_OUTWARD");
  }
}

absl::StatusOr<FrameEncoding> FromProto(v1::FrameEncoding encoding, const std::string& field) {
  switch (encoding) {
    case v1::FRAME_ENCODING_GRAY8:
      return FrameEncoding::kGray8;
    case v1::FRAME_ENCODING_RGB8:
      return FrameEncoding::kRgb8;
    case v1::FRAME_ENCODING_BGR8:
      return FrameEncoding::kBgr8;
    case v1::FRAME_ENCODING_JPEG:
      return FrameEncoding::kJpeg;
    case v1::FRAME_ENCODING_PNG:
      return FrameEncoding::kPng;
    default:
      return UnknownValue(field, encoding, "GRAY8, RGB8, BGR8, JPEG or PNG");
  }
}

}  // namespace homing::wire
