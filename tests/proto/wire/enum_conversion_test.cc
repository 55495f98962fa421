#include "proto/wire/enum_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace homing::wire {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <typename Value>
void ExpectRoundTrip(std::initializer_list<Value> values) {
  for (Value value : values) {
    const auto back = FromProto(ToProto(value), "field");
    ASSERT_THAT(back, IsOk());
    EXPECT_EQ(*back, value);
  }
}

TEST(EnumConversion, EveryValueComesBack) {
  ExpectRoundTrip({Side::kLeft, Side::kRight});
  ExpectRoundTrip({Motion::kMoving, Motion::kStanding, Motion::kTurning});
  ExpectRoundTrip({Travel::kReturn, Travel::kSame});
  ExpectRoundTrip({Outcome::kMatch, Outcome::kAmbiguous, Outcome::kUnknownPlace});
  ExpectRoundTrip({Direction::kUnknown, Direction::kHomeward, Direction::kOutward});
  ExpectRoundTrip({FrameEncoding::kGray8, FrameEncoding::kRgb8, FrameEncoding::kBgr8,
                   FrameEncoding::kJpeg, FrameEncoding::kPng});
}

TEST(EnumConversion, WordsAgree) {
  EXPECT_EQ(ToProto(Side::kRight), v1::SIDE_RIGHT);
  EXPECT_EQ(ToProto(Motion::kTurning), v1::MOTION_TURNING);
  EXPECT_EQ(ToProto(Travel::kSame), v1::TRAVEL_SAME);
  EXPECT_EQ(ToProto(Outcome::kUnknownPlace), v1::OUTCOME_UNKNOWN_PLACE);
  EXPECT_EQ(ToProto(Direction::kOutward), v1::DIRECTION_OUTWARD);
  EXPECT_EQ(ToProto(FrameEncoding::kPng), v1::FRAME_ENCODING_PNG);
}

TEST(EnumConversion, UnspecifiedAndUnknownValuesAreRefusedByName) {
  const auto refused = StatusIs(absl::StatusCode::kInvalidArgument,
                                AllOf(HasSubstr("a.b: "), HasSubstr(" must be ")));
  EXPECT_THAT(FromProto(v1::SIDE_UNSPECIFIED, "a.b"), refused);
  EXPECT_THAT(FromProto(v1::MOTION_UNSPECIFIED, "a.b"), refused);
  EXPECT_THAT(FromProto(v1::OUTCOME_UNSPECIFIED, "a.b"), refused);
  EXPECT_THAT(FromProto(v1::FRAME_ENCODING_UNSPECIFIED, "a.b"), refused);
  EXPECT_THAT(FromProto(static_cast<v1::FrameEncoding>(77), "a.b"), refused);
  EXPECT_THAT(FromProto(static_cast<v1::Travel>(77), "a.b"), refused);
  EXPECT_THAT(FromProto(static_cast<v1::Direction>(77), "a.b"), refused);
}

TEST(EnumConversion, UnspecifiedTravelIsReturn) {
  EXPECT_EQ(FromProto(v1::TRAVEL_UNSPECIFIED, "travel").value(), Travel::kReturn);
}

TEST(EnumConversion, AFingerprintKeepsItsBits) {
  const v1::Fingerprint message = ToProto(Side::kRight, Fingerprint{0.1F, 1e-30F, 9, 4});
  EXPECT_EQ(message.x(), 0.1F);
  EXPECT_EQ(message.y(), 1e-30F);
  EXPECT_EQ(message.count(), 9);
  EXPECT_EQ(message.landmark(), 4);
  EXPECT_EQ(message.side(), v1::SIDE_RIGHT);
}

}  // namespace
}  // namespace homing::wire
