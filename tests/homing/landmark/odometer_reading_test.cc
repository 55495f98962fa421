#include "homing/landmark/odometer_reading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

// A grid of midpoints; the motion of each is `of(x, y)`, from the middle of the image.
template <typename Motion>
FlowField FieldOf(Motion of) {
  FlowField field{.width = 320, .height = 240, .vectors = {}};
  for (float y = -90; y <= 90; y += 20) {
    for (float x = -120; x <= 120; x += 20) {
      const auto [dx, dy] = of(x, y);
      field.vectors.push_back(
          {160 + x - dx / 2, 120 + y - dy / 2, 160 + x + dx / 2, 120 + y + dy / 2});
    }
  }
  return field;
}

TEST(OdometerReadingTest, TranslationIsTheMedianAndTheLength) {
  for (const float px : {-8.0F, -1.0F, 0.5F, 4.0F}) {
    const OdometerReading reading =
        ReadOdometer(FieldOf([px](float, float) { return std::pair(px, 0.0F); }));
    EXPECT_NEAR(reading.median_x, px * OdometerReading::kSignedPerPx, 1);
    EXPECT_NEAR(reading.length_code, 1 + 20 * (std::log2(std::abs(px)) + 4), 1);
    EXPECT_EQ(reading.spread_code, 1);
    EXPECT_NEAR(reading.expansion, 0, 1);
  }
}

TEST(OdometerReadingTest, TwiceTheFlowIsAnOctave) {
  const auto at = [](float px) {
    return ReadOdometer(FieldOf([px](float, float) { return std::pair(px, 0.0F); })).length_code;
  };
  EXPECT_EQ(at(4) - at(2), 20);
}

TEST(OdometerReadingTest, ExpansionHasTheSignOfTheMotionAlong) {
  for (const float part : {-0.05F, 0.05F}) {
    const OdometerReading reading =
        ReadOdometer(FieldOf([part](float x, float y) { return std::pair(part * x, part * y); }));
    // Pixels for each image width from the middle.
    EXPECT_NEAR(reading.expansion, part * 320 * OdometerReading::kSignedPerPx, 20);
    EXPECT_NEAR(reading.median_x, 0, 1);
    EXPECT_GT(reading.spread_code, 1);
  }
}

TEST(OdometerReadingTest, ATurnLeavesTheSpread) {
  const auto with_turn = [](float turn) {
    return ReadOdometer(
        FieldOf([turn](float x, float y) { return std::pair(0.03F * x + turn, 0.03F * y); }));
  };
  EXPECT_NEAR(with_turn(6).spread_code, with_turn(0).spread_code, 1);
  EXPECT_NEAR(with_turn(6).median_x - with_turn(0).median_x, 6 * 32, 2);
}

TEST(OdometerReadingTest, FewVectorsSayNothing) {
  FlowField field = FieldOf([](float, float) { return std::pair(2.0F, 0.0F); });
  field.vectors.resize(OdometerReading::kLeastVectors - 1);
  EXPECT_FALSE(ReadOdometer(field).has_value());
}

TEST(OdometerReadingTest, ATurnOfNothingIsAReading) {
  OdometerReading reading;
  EXPECT_FALSE(reading.turn());
  for (const double turn : {0.0, 0.01, -0.01, 5.0}) {
    reading.turn_code = OdometerReading::TurnCode(turn);
    ASSERT_TRUE(reading.turn()) << turn;
    EXPECT_NEAR(*reading.turn(), std::min(turn, 2.0), 1e-3);
  }
}

}  // namespace
}  // namespace homing
