// When the pilot searches for its place, and how.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "client/pilot/pilot.h"
#include "tests/client/pilot/answered_pilot.h"

namespace homing::client {
namespace {

class PilotSearchTest : public AnsweredPilotTest {
 protected:
  static PilotAnswer Unsure(double remaining_m, double probability = 0.6) {
    PilotAnswer answer = Sure(remaining_m);
    answer.outcome = PilotAnswer::Outcome::kAmbiguous;
    answer.probability = probability;
    return answer;
  }
};

TEST_F(PilotSearchTest, IsSlowerWhenUnsureAndSearchesAfterAWhile) {
  Pilot pilot = OnItsWay();
  const double sure = Step(pilot).speed_mps;
  EXPECT_LT(Step(pilot, Lost()).speed_mps, sure);
  bool back = false;
  for (int i = 0; i < 900; ++i) back = Step(pilot, Lost()).speed_mps < 0 || back;
  EXPECT_EQ(pilot.state(), Pilot::State::kSearching);
  EXPECT_TRUE(back);
}

// Ahead, it would get further and further beside the path.
TEST_F(PilotSearchTest, ASearchBeginsWhereThePlaceWasLastKnownAndStaysNear) {
  Pilot pilot = OnItsWay();
  while (pilot.state() != Pilot::State::kSearching) Step(pilot, Lost());
  const double begin_m = pilot.remaining_m();
  EXPECT_LT(Step(pilot, Lost()).speed_mps, 0);
  double ahead_m = 0, behind_m = 0;
  for (int i = 0; i < 3000; ++i) {
    Step(pilot, Lost());
    ahead_m = std::max(ahead_m, begin_m - pilot.remaining_m());
    behind_m = std::max(behind_m, pilot.remaining_m() - begin_m);
  }
  EXPECT_GT(behind_m, 3);
  EXPECT_LT(ahead_m, 7);
}

// The heading is known as well as the way was long over which it was compared with the offsets.
TEST_F(PilotSearchTest, DrivesOnUnsureForTwiceTheWayOnWhichItWasSure) {
  std::array<double, 2> unsure_m{};
  for (std::size_t i = 0; i < 2; ++i) {
    Pilot pilot = OnItsWay();
    for (int step = 0; step < (i == 0 ? 1 : 50); ++step) Step(pilot, Sure(pilot.remaining_m()));
    const double begin_m = pilot.remaining_m();
    while (pilot.state() != Pilot::State::kSearching) Step(pilot, Lost());
    unsure_m[i] = begin_m - pilot.remaining_m();
    sequence_ = 0;
    now_s_ = 0;
  }
  EXPECT_NEAR(unsure_m[0], 4, 0.6);
  EXPECT_NEAR(unsure_m[1], 4 + 2 * 4.5, 1.5);
}

// An answer that is not sure, but right, is better than none: going back would lose the place.
TEST_F(PilotSearchTest, DrivesOnWhereUnsureAnswersAgreeWithIt) {
  Pilot pilot = OnItsWay();
  const double begin_m = pilot.remaining_m();
  while (pilot.remaining_m() > begin_m - 20) {
    Step(pilot, Unsure(pilot.remaining_m()));
    ASSERT_EQ(pilot.state(), Pilot::State::kDriving);
  }
}

TEST_F(PilotSearchTest, EndsASearchWhereAnUnsureAnswerAgreesWithIt) {
  Pilot pilot = OnItsWay();
  while (pilot.state() != Pilot::State::kSearching) Step(pilot, Lost());
  Step(pilot, Unsure(pilot.remaining_m()));
  EXPECT_EQ(pilot.state(), Pilot::State::kDriving);
}

TEST_F(PilotSearchTest, SearchesWhereUnsureAnswersNameAnotherPlaceOrHardlyAny) {
  for (const double probability : {0.3, 0.6}) {
    Pilot pilot = OnItsWay();
    for (int i = 0; i < 200 && pilot.state() == Pilot::State::kDriving; ++i) {
      const double ahead_m = probability > 0.5 ? 20 : 0;
      Step(pilot, Unsure(pilot.remaining_m() - ahead_m, probability));
    }
    EXPECT_EQ(pilot.state(), Pilot::State::kSearching) << probability;
    sequence_ = 0;
    now_s_ = 0;
  }
}

// A stretch that has changed may be long: to and fro on it alone the robot would stay for ever.
TEST_F(PilotSearchTest, ASearchGoesFurtherAndFurther) {
  Pilot pilot = OnItsWay();
  while (pilot.state() != Pilot::State::kSearching) Step(pilot, Lost());
  const double begin_m = pilot.remaining_m();
  double ahead_m = 0, behind_m = 0;
  for (int i = 0; i < 1000; ++i) {
    Step(pilot, Lost());
    ahead_m = std::max(ahead_m, begin_m - pilot.remaining_m());
    behind_m = std::max(behind_m, pilot.remaining_m() - begin_m);
  }
  EXPECT_GT(ahead_m, 5);
  EXPECT_GT(behind_m, 1);
}

}  // namespace
}  // namespace homing::client
