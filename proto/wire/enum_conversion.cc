#include "proto/wire/enum_conversion.h"

#include <google/protobuf/generated_enum_reflection.h>

#include <array>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "homing/base/field_error.h"

namespace homing::wire {
namespace {

// One table for each enumeration, for both directions.
constexpr std::array kSides = {std::pair(Side::kLeft, v1::SIDE_LEFT),
                               std::pair(Side::kRight, v1::SIDE_RIGHT)};
constexpr std::array kMotions = {std::pair(Motion::kMoving, v1::MOTION_MOVING),
                                 std::pair(Motion::kStanding, v1::MOTION_STANDING),
                                 std::pair(Motion::kTurning, v1::MOTION_TURNING)};
constexpr std::array kTravels = {std::pair(Travel::kReturn, v1::TRAVEL_RETURN),
                                 std::pair(Travel::kSame, v1::TRAVEL_SAME)};
constexpr std::array kOutcomes = {std::pair(Outcome::kMatch, v1::OUTCOME_MATCH),
                                  std::pair(Outcome::kAmbiguous, v1::OUTCOME_AMBIGUOUS),
                                  std::pair(Outcome::kUnknownPlace, v1::OUTCOME_UNKNOWN_PLACE)};
constexpr std::array kDirections = {std::pair(Direction::kHomeward, v1::DIRECTION_HOMEWARD),
                                    std::pair(Direction::kOutward, v1::DIRECTION_OUTWARD)};
constexpr std::array kEncodings = {std::pair(FrameEncoding::kGray8, v1::FRAME_ENCODING_GRAY8),
                                   std::pair(FrameEncoding::kRgb8, v1::FRAME_ENCODING_RGB8),
                                   std::pair(FrameEncoding::kBgr8, v1::FRAME_ENCODING_BGR8),
                                   std::pair(FrameEncoding::kJpeg, v1::FRAME_ENCODING_JPEG),
                                   std::pair(FrameEncoding::kPng, v1::FRAME_ENCODING_PNG)};

// The unspecified value, 0, if the table does not hold `value`.
template <typename Value, typename Message, std::size_t size>
Message MessageOf(const std::array<std::pair<Value, Message>, size>& table, Value value) {
  for (const auto& [known, message] : table) {
    if (known == value) return message;
  }
  return Message{};
}

// INVALID_ARGUMENT naming `field` and the valid values.
template <typename Value, typename Message, std::size_t size>
absl::StatusOr<Value> ValueOf(const std::array<std::pair<Value, Message>, size>& table,
                              Message message, const std::string& field) {
  for (const auto& [value, known] : table) {
    if (known == message) return value;
  }
  const auto* descriptor = google::protobuf::GetEnumDescriptor<Message>();
  return MustBe(
      field, static_cast<int>(message),
      absl::StrCat("one of ", absl::StrJoin(table, ", ", [&](std::string* text, const auto& entry) {
                     absl::StrAppend(text, descriptor->FindValueByNumber(entry.second)->name());
                   })));
}

}  // namespace

v1::Side ToProto(Side side) { return MessageOf(kSides, side); }
v1::Motion ToProto(Motion motion) { return MessageOf(kMotions, motion); }
v1::Travel ToProto(Travel travel) { return MessageOf(kTravels, travel); }
v1::Outcome ToProto(Outcome outcome) { return MessageOf(kOutcomes, outcome); }
v1::Direction ToProto(Direction direction) { return MessageOf(kDirections, direction); }
v1::FrameEncoding ToProto(FrameEncoding encoding) { return MessageOf(kEncodings, encoding); }

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
  return ValueOf(kSides, side, field);
}
absl::StatusOr<Motion> FromProto(v1::Motion motion, const std::string& field) {
  return ValueOf(kMotions, motion, field);
}
absl::StatusOr<Travel> FromProto(v1::Travel travel, const std::string& field) {
  return travel == v1::TRAVEL_UNSPECIFIED ? absl::StatusOr<Travel>(Travel::kReturn)
                                          : ValueOf(kTravels, travel, field);
}
absl::StatusOr<Outcome> FromProto(v1::Outcome outcome, const std::string& field) {
  return ValueOf(kOutcomes, outcome, field);
}
absl::StatusOr<Direction> FromProto(v1::Direction direction, const std::string& field) {
  return direction == v1::DIRECTION_UNSPECIFIED ? absl::StatusOr<Direction>(Direction::kUnknown)
                                                : ValueOf(kDirections, direction, field);
}
absl::StatusOr<FrameEncoding> FromProto(v1::FrameEncoding encoding, const std::string& field) {
  return ValueOf(kEncodings, encoding, field);
}

}  // namespace homing::wire
