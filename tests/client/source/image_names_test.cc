#include "client/source/image_names.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

using Names = std::vector<std::string>;

Names Sorted(Names names) {
  SortByName(&names);
  return names;
}

TEST(ImageNamesTest, DecimalNumbersAreComparedAsSuch) {
  EXPECT_EQ(Sorted({"d/0.1.png", "d/0.05.png", "d/0.png", "d/10.5.png", "d/9.25.png"}),
            (Names{"d/0.png", "d/0.05.png", "d/0.1.png", "d/9.25.png", "d/10.5.png"}));
  EXPECT_EQ(Sorted({"1700000000.9.jpg", "1700000000.10.jpg", "1700000001.0.jpg"}),
            (Names{"1700000000.10.jpg", "1700000000.9.jpg", "1700000001.0.jpg"}));
}

TEST(ImageNamesTest, OneOtherNameMakesTheOrderNatural) {
  EXPECT_EQ(Sorted({"1.10.png", "1.9.png", "a.png"}), (Names{"1.9.png", "1.10.png", "a.png"}));
  EXPECT_EQ(Sorted({"v1.10.png", "v1.9.png"}), (Names{"v1.9.png", "v1.10.png"}));
}

TEST(ImageNamesTest, TimesAndNumbersAreKeys) {
  const FrameKeys seconds = KeysOfNames({"0.05.png", "0.1.png"});
  EXPECT_EQ(seconds.kind, FrameKeys::Kind::kTime);
  EXPECT_EQ(seconds.values, (std::vector<std::int64_t>{50'000'000, 100'000'000}));
  const FrameKeys micros = KeysOfNames({"1403636579763555.png", "1403636579813555.png"});
  EXPECT_EQ(micros.kind, FrameKeys::Kind::kTime);
  EXPECT_EQ(micros.values[1] - micros.values[0], 50'000'000);
  const FrameKeys numbers = KeysOfNames({"cam0_000007.png", "cam0_000008.png"});
  EXPECT_EQ(numbers.kind, FrameKeys::Kind::kNumber);
  EXPECT_EQ(numbers.values, (std::vector<std::int64_t>{7, 8}));
}

// Of milliseconds, microseconds and nanoseconds, the largest that fit into 64 bits.
TEST(ImageNamesTest, NumbersTooLargeForAClockAreNumbers) {
  EXPECT_EQ(*ParseTime("9223372036854"), 9223372036854000000);
  EXPECT_EQ(*ParseTime("9223372036854775807"), 9223372036854775807);
  EXPECT_FALSE(ParseTime("9223372036855").has_value());
  EXPECT_FALSE(ParseTime("99999999999999999").has_value());
  EXPECT_FALSE(ParseTime("9223372036854775808").has_value());
  EXPECT_EQ(KeysOfNames({"99999999999999998.png", "99999999999999999.png"}).kind,
            FrameKeys::Kind::kNumber);
  EXPECT_EQ(KeysOfNames({"100000000000.png", "99999999999999999.png"}).kind,
            FrameKeys::Kind::kNumber);
}

TEST(ImageNamesTest, NamesThatDoNotAscendHaveNoKeys) {
  EXPECT_EQ(KeysOfNames({"a1_5.png", "a2_5.png"}).kind, FrameKeys::Kind::kOrder);
  EXPECT_EQ(KeysOfNames({"a.png", "b.png"}).kind, FrameKeys::Kind::kOrder);
  EXPECT_EQ(KeysOfNames({"0.5.png", "0.50.png"}).kind, FrameKeys::Kind::kOrder);
  EXPECT_EQ(KeysOfNames({}).kind, FrameKeys::Kind::kOrder);
}

}  // namespace
}  // namespace homing::client
