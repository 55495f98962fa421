#include "homing/profile/route_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "homing/profile/shared_change.h"

namespace homing {
namespace {

OdometerReading Reading(double median_x, double expansion, int code) {
  return {.median_x = static_cast<std::int16_t>(median_x),
          .expansion = static_cast<std::int16_t>(expansion),
          .length_code = static_cast<std::uint8_t>(code),
          .spread_code = static_cast<std::uint8_t>(code + 20)};
}

// Profiles that change over some steps and never repeat.
FlowProfile ProfileAt(double at) {
  FlowProfile profile;
  for (std::size_t cell = 0; cell < profile.cells.size(); ++cell) {
    const double phase =
        0.31 * at * (1 + 0.013 * static_cast<double>(cell % 37)) + 1.7 * static_cast<double>(cell);
    profile.cells[cell] = static_cast<std::uint8_t>(0x80 | std::lround(7 + 7 * std::sin(phase)));
  }
  profile.odometer = Reading(160, 0, 100);
  return profile;
}

JourneyMap MapOfSteps(int steps) {
  JourneyMap map;
  for (int step = 0; step < steps; ++step) {
    JourneyStep recorded{
        .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    recorded.profiles[0] = ProfileAt(step);
    EXPECT_TRUE(map.Append(recorded).ok());
  }
  return map;
}

std::vector<FlowProfile> ProfilesWith(double median_x, double expansion) {
  std::vector<FlowProfile> profiles(20);
  for (FlowProfile& profile : profiles) profile.odometer = Reading(median_x, expansion, 100);
  return profiles;
}

TEST(CameraOdometerTest, ReadsWhereTheCameraLooksFromTheSigns) {
  std::vector<FlowProfile> across = ProfilesWith(100, 10), along = ProfilesWith(10, 100);
  for (std::size_t i = 0; i < across.size(); i += 2) {
    across[i].odometer.expansion = -10;
    along[i].odometer.median_x = -10;
  }
  EXPECT_EQ(CameraOdometer(across).direction(), CameraDirection::kAcross);
  EXPECT_EQ(CameraOdometer(along).direction(), CameraDirection::kAlong);
  EXPECT_EQ(CameraOdometer(ProfilesWith(10, 10)).direction(), CameraDirection::kMixed);
  EXPECT_EQ(CameraOdometer(across).Read(Reading(1, 1, 90)), 90);
  EXPECT_EQ(CameraOdometer(along).Read(Reading(1, 1, 90)), 110);
}

TEST(CameraOdometerTest, ASteadySignTellsTheWay) {
  const CameraOdometer steady(ProfilesWith(-100, 10));
  EXPECT_GT(steady.OutwardLogOdds(Reading(-5, 0, 90)), 2);
  EXPECT_LT(steady.OutwardLogOdds(Reading(5, 0, 90)), -2);
  EXPECT_EQ(steady.OutwardLogOdds(Reading(0, 0, 90)), 0);
}

TEST(CameraOdometerTest, ASignThatChangesOverTheMapTellsLittle) {
  std::vector<FlowProfile> turning = ProfilesWith(100, 0);
  for (std::size_t i = 0; i < turning.size(); i += 4) turning[i].odometer.median_x = -100;
  const CameraOdometer odometer(turning);
  EXPECT_GT(odometer.OutwardLogOdds(Reading(5, 0, 90)), 0);
  EXPECT_LT(odometer.OutwardLogOdds(Reading(5, 0, 90)), 1.5);
}

TEST(CameraOdometerTest, AStepWithoutAReadingHasNone) {
  EXPECT_EQ(CameraOdometer(ProfilesWith(10, 10)).Read({}), CameraOdometer::kNone);
}

TEST(RouteScaleTest, AMapWithoutProfilesHasNoSides) {
  const RouteScale route = MeasureRoute(JourneyMap());
  EXPECT_FALSE(route.sides[0]);
  EXPECT_FALSE(route.sides[1]);
  EXPECT_EQ(route.correlation_steps, 1);
}

TEST(RouteScaleTest, ASteadyDriveHasNoNoiseAndItsOwnReadingEverywhere) {
  const RouteScale route = MeasureRoute(MapOfSteps(120));
  ASSERT_TRUE(route.sides[0]);
  EXPECT_EQ(route.odometer_noise, 0);
  EXPECT_GE(route.correlation_steps, 1);
  EXPECT_LT(route.correlation_steps, 10);
  for (const std::int16_t reading : route.sides[0]->usual_readings) EXPECT_EQ(reading, 100);
}

TEST(RouteScaleTest, AMapIsMeasuredOnceUntilItHasGrownMuch) {
  JourneyMap map = MapOfSteps(100);
  const auto first = MeasuredScale(map);
  EXPECT_EQ(MeasuredScale(map), first);
  const JourneyMap copy = map;
  EXPECT_EQ(MeasuredScale(copy), first);
  map.ExtendTo(120);
  EXPECT_EQ(MeasuredScale(map), first);
  map.ExtendTo(130);
  EXPECT_NE(MeasuredScale(map), first);
}

// A drive that sees `seen(step)` and is believed to be at `step`: what is shared at its end.
template <typename Seen>
double SharedAtTheEnd(const JourneyMap& map, Seen seen) {
  static const CellMask all = CoveredCells(1);
  const std::string name = "robots/a/journeys/b";
  const JourneyRef journey{&name, &map};
  const RouteScale route = MeasureRoute(map);
  SharedChange change;
  std::optional<double> shared;
  for (int step = 20; step < 60; ++step) {
    BelievedInstant now{.journey = 0, .step = step};
    now.seen[0] = {.profile = seen(step), .covered = &all};
    now.moved = step - 20;
    shared = change.Add({&journey, 1}, route, now);
    if (step == 20) {
      EXPECT_FALSE(shared);
    }
  }
  return shared.value_or(-9);
}

TEST(SharedChangeTest, TheSameWayIsShared) {
  EXPECT_GT(SharedAtTheEnd(MapOfSteps(120), ProfileAt), 0.3);
}

TEST(SharedChangeTest, AViewThatIsNearToEveryPlaceSharesNothing) {
  EXPECT_LT(SharedAtTheEnd(MapOfSteps(120), [](int) { return ProfileAt(40); }), 0);
}

TEST(SharedChangeTest, FewerVectorsInPoorLightAreShared) {
  const auto dark = [](int step) {
    FlowProfile profile = ProfileAt(step);
    for (std::uint8_t& cell : profile.cells) {
      cell = static_cast<std::uint8_t>((cell & 0xf0) | ((cell & 15) * 2 / 3));
    }
    return profile;
  };
  EXPECT_GT(SharedAtTheEnd(MapOfSteps(120), dark), 0);
}

}  // namespace
}  // namespace homing
