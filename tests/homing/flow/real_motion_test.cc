#include <gtest/gtest.h>

#include <array>

#include "homing/flow/motion.h"
#include "tests/support/real_sequences.h"

namespace homing {
namespace {

struct Tally {
  int moving = 0;
  int standing = 0;
  int turning = 0;
};

Tally TallyOf(const std::string& sequence, std::size_t count) {
  ObservationFlow tracker({});
  Tally tally;
  for (const cv::Mat& image : ReadImages(RealSequence(sequence), count)) {
    Observation observation;
    observation.views[0] =
        Frame{FrameEncoding::kGray8,
              image.cols,
              image.rows,
              {reinterpret_cast<const char*>(image.data), static_cast<std::size_t>(image.total())}};
    const ObservedFlow flow = tracker.Compute(observation).value();
    if (flow.fields[0].has_value()) {
      const Motion motion = ClassifyMotion(flow, {});
      ++(motion == Motion::kMoving     ? tally.moving
         : motion == Motion::kStanding ? tally.standing
                                       : tally.turning);
    }
  }
  return tally;
}

TEST(RealMotionTest, ACameraThatStandsIsStandingThroughout) {
  HOMING_SKIP_WITHOUT("still");
  const Tally tally = TallyOf("still", 30);
  EXPECT_EQ(tally.standing, 29);
}

class MovingSequenceTest : public ::testing::TestWithParam<std::string> {};

TEST_P(MovingSequenceTest, IsMovingNearlyThroughout) {
  HOMING_SKIP_WITHOUT(GetParam());
  const Tally tally = TallyOf(GetParam(), 120);
  ASSERT_GT(tally.moving, 10);
  EXPECT_LE(tally.standing + tally.turning, 0.05 * tally.moving);
}

INSTANTIATE_TEST_SUITE_P(Sequences, MovingSequenceTest,
                         ::testing::Values("laps/lap1", "laps/lap2", "laps/lap2_dim",
                                           "gantry/row00", "gantry/row08", "gantry/row16",
                                           "shop/row00", "shop/row13", "shop/row26"));

}  // namespace
}  // namespace homing
