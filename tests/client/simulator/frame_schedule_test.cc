#include "client/simulator/frame_schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace homing::client {
namespace {

using ::testing::ElementsAre;

FrameSchedule Schedule(const std::string& keys, std::int64_t taken) {
  const auto spec = ParseSimulationSpec("sim:street" + keys);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return {spec.value_or(SimulationSpec()), taken};
}

std::vector<std::int64_t> AllOf(const FrameSchedule& schedule) {
  std::vector<std::int64_t> taken;
  for (std::int64_t i = 0; i < schedule.frame_count(); ++i) taken.push_back(schedule.TakenAt(i));
  return taken;
}

TEST(FrameScheduleTest, WithoutKeysEachFrameArrivesOnce) {
  EXPECT_THAT(AllOf(Schedule("", 4)), ElementsAre(0, 1, 2, 3));
  EXPECT_FALSE(Schedule("", 4).IsAbsent(2, Side::kLeft));
}

TEST(FrameScheduleTest, EveryFifthFrameRepeatsTheOneBefore) {
  EXPECT_THAT(AllOf(Schedule(",repeat=5", 9)), ElementsAre(0, 1, 2, 3, 3, 4, 5, 6, 7, 7, 8));
  EXPECT_THAT(AllOf(Schedule(",repeat=2", 3)), ElementsAre(0, 0, 1, 1, 2, 2));
}

TEST(FrameScheduleTest, AShareOfTheFramesIsLostInOrder) {
  for (const std::int64_t taken : {400, 407, 419}) {
    const auto arrived = AllOf(Schedule(",drop=0.3", taken));
    EXPECT_NEAR(static_cast<double>(arrived.size()), 0.7 * static_cast<double>(taken), 7);
    for (std::size_t i = 1; i < arrived.size(); ++i) EXPECT_LT(arrived[i - 1], arrived[i]);
    EXPECT_LT(arrived.back(), taken);
  }
  EXPECT_NE(AllOf(Schedule(",drop=0.3,drive=2", 400)),
            AllOf(Schedule(",drop=0.3,drive=2,seed=2", 400)));
}

TEST(FrameScheduleTest, LostAndRepeatedFramesGoTogether) {
  const FrameSchedule schedule = Schedule(",drop=0.5,repeat=3", 40);
  ASSERT_EQ(schedule.frame_count(), 30);
  for (std::int64_t i = 2; i < 30; i += 3) {
    EXPECT_EQ(schedule.TakenAt(i), schedule.TakenAt(i - 1));
    EXPECT_GT(schedule.TakenAt(i - 1), schedule.TakenAt(i - 2));
  }
}

TEST(FrameScheduleTest, OneCameraLosesFramesInARow) {
  const FrameSchedule schedule = Schedule(",drop_run=10", 500);
  EXPECT_EQ(schedule.frame_count(), 500);
  std::array<int, 2> lost{};
  for (std::int64_t stretch = 0; stretch < 10; ++stretch) {
    std::vector<std::int64_t> absent;
    for (std::int64_t i = 50 * stretch; i < 50 * (stretch + 1); ++i) {
      const bool left = schedule.IsAbsent(i, Side::kLeft);
      const bool right = schedule.IsAbsent(i, Side::kRight);
      EXPECT_FALSE(left && right);
      lost[0] += left ? 1 : 0;
      lost[1] += right ? 1 : 0;
      if (left || right) absent.push_back(i);
    }
    ASSERT_EQ(absent.size(), 10U);
    EXPECT_EQ(absent.back() - absent.front(), 9);
  }
  EXPECT_GT(lost[0], 0);
  EXPECT_GT(lost[1], 0);
}

}  // namespace
}  // namespace homing::client
