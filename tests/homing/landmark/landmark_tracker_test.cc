#include "homing/landmark/landmark_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>
#include <vector>

namespace homing {
namespace {

using ::testing::ElementsAre;

SeenLandmark Seen(double x, double flow_x = 5, double y = 100) {
  return {static_cast<float>(x), static_cast<float>(y), 30, flow_x, 0, 0.1};
}

std::vector<int> Numbers(const std::vector<Fingerprint>& fingerprints) {
  std::vector<int> numbers;
  for (const Fingerprint& f : fingerprints) {
    numbers.push_back(f.landmark);
  }
  return numbers;
}

TEST(LandmarkTrackerTest, ALandmarkThatMovesAsItsFlowSaysStaysTheSame) {
  LandmarkTracker tracker({});
  for (int step = 0; step < 10; ++step) {
    // 40 px a step is over the gate: only the flow explains it.
    const auto counted = tracker.Associate(step, Side::kLeft, {Seen(20 + 40 * step, 40)});
    EXPECT_THAT(Numbers(counted), ElementsAre(0));
  }
  EXPECT_EQ(tracker.landmark_count(), 1);
}

TEST(LandmarkTrackerTest, FingerprintsKeepMeanAndNumber) {
  LandmarkTracker tracker({});
  const auto counted = tracker.Associate(0, Side::kRight, {Seen(70.25)});
  ASSERT_EQ(counted.size(), 1U);
  EXPECT_EQ(counted[0], (Fingerprint{70.25F, 100, 30, 0}));
}

TEST(LandmarkTrackerTest, AJumpBeyondTheGateIsANewLandmark) {
  LandmarkTracker tracker({});
  tracker.Associate(0, Side::kLeft, {Seen(100)});
  EXPECT_THAT(Numbers(tracker.Associate(1, Side::kLeft, {Seen(105 + 19.9)})), ElementsAre(0));
  EXPECT_THAT(Numbers(tracker.Associate(2, Side::kLeft, {Seen(129.9 + 20.2)})), ElementsAre(1));
}

TEST(LandmarkTrackerTest, NewLandmarksAreNumberedInTheOrderMet) {
  LandmarkTracker tracker({});
  EXPECT_THAT(Numbers(tracker.Associate(0, Side::kLeft, {Seen(50), Seen(250)})), ElementsAre(0, 1));
  EXPECT_THAT(Numbers(tracker.Associate(0, Side::kRight, {Seen(50)})), ElementsAre(2));
  // The one at 250 has left, another has come in at the low end.
  EXPECT_THAT(Numbers(tracker.Associate(1, Side::kLeft, {Seen(10), Seen(55)})), ElementsAre(3, 0));
}

TEST(LandmarkTrackerTest, SidesDoNotMix) {
  LandmarkTracker tracker({});
  tracker.Associate(0, Side::kLeft, {Seen(100)});
  EXPECT_THAT(Numbers(tracker.Associate(1, Side::kRight, {Seen(105)})), ElementsAre(1));
}

TEST(LandmarkTrackerTest, NearestPairGoesFirstAndOneToOne) {
  LandmarkTracker tracker({});
  tracker.Associate(0, Side::kLeft, {Seen(100)});
  // Both are within the gate of landmark 0; the second is nearer.
  EXPECT_THAT(Numbers(tracker.Associate(1, Side::kLeft, {Seen(95), Seen(107)})), ElementsAre(1, 0));
}

TEST(LandmarkTrackerTest, AMissingLandmarkComesBackWithinTheGap) {
  LandmarkOptions options;
  options.max_track_gap_steps = 2;
  LandmarkTracker tracker(options);
  tracker.Associate(0, Side::kLeft, {Seen(100, 30)});
  tracker.Associate(1, Side::kLeft, {});
  tracker.Associate(2, Side::kLeft, {});
  // Moved on by three steps of its flow.
  EXPECT_THAT(Numbers(tracker.Associate(3, Side::kLeft, {Seen(190, 30)})), ElementsAre(0));
  EXPECT_THAT(Numbers(tracker.Associate(7, Side::kLeft, {Seen(310, 30)})), ElementsAre(1));
}

TEST(LandmarkTrackerTest, RestoredCountGoesOn) {
  LandmarkTracker tracker({});
  tracker.set_landmark_count(17);
  EXPECT_THAT(Numbers(tracker.Associate(5, Side::kLeft, {Seen(100)})), ElementsAre(17));
}

struct Stored {
  std::int64_t step;
  Side side;
  Fingerprint fingerprint;
};

// Landmarks drift, vanish, and come up on both sides.
std::vector<SeenLandmark> RandomScene(cv::RNG& random, std::int64_t step, Side side) {
  std::vector<SeenLandmark> seen;
  for (int k = 0; k < 2; ++k) {
    if (random.uniform(0.0, 1.0) < 0.7) {
      const double x = std::fmod(6.0 * double(step) + 150 * k + 40 * int(side), 320);
      seen.push_back(Seen(x + random.gaussian(6), 6 + random.gaussian(1)));
    }
  }
  return seen;
}

TEST(LandmarkTrackerTest, ATrackerRestoredFromStoredFingerprintsCountsAsTheUndisturbedOne) {
  const LandmarkOptions options;
  cv::RNG random(4);
  LandmarkTracker undisturbed(options);
  std::vector<Stored> stored;
  for (std::int64_t step = 0; step < 300; ++step) {
    LandmarkTracker restored(options);
    for (const Stored& s : stored) {
      if (s.step >= step - options.max_track_gap_steps - 1) {
        restored.Restore(s.step, s.side, s.fingerprint);
      }
    }
    restored.set_landmark_count(undisturbed.landmark_count());
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const auto seen = RandomScene(random, step, side);
      const auto expected = undisturbed.Associate(step, side, seen);
      ASSERT_EQ(restored.Associate(step, side, seen), expected);
      for (const Fingerprint& f : expected) {
        stored.push_back({step, side, f});
      }
    }
  }
  EXPECT_GT(undisturbed.landmark_count(), 10);
}

}  // namespace
}  // namespace homing
