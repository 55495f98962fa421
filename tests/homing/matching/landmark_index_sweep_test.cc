// Removed journeys give their memory and numbers back.
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "homing/matching/landmark_index.h"

namespace homing {
namespace {

TEST(LandmarkIndexSweepTest, SweptJourneysFreeTheirMemory) {
  LandmarkIndex index;
  std::size_t bytes = 0;
  for (int round = 0; round < 20; ++round) {
    const int journey = index.AddJourney(absl::StrCat("robots/r/journeys/", round), {});
    for (int step = 0; step < 5'000; ++step) {
      JourneyStep recorded;
      recorded.step = step;
      recorded.fingerprints.push_back({Side::kLeft,
                                       {static_cast<float>(step % 97),
                                        static_cast<float>(step % 89), 1 + step % 83, step / 100},
                                       0});
      index.Append(journey, recorded);
    }
    index.Remove(journey);
    while (index.Sweep(64)) {
    }
    if (round == 0) bytes = index.MemoryBytes();
  }
  EXPECT_EQ(index.fingerprint_count(), 0);
  EXPECT_LT(index.MemoryBytes(), 2 * bytes);
}

TEST(LandmarkIndexSweepTest, NumbersOfSweptJourneysAreReused) {
  LandmarkIndex index;
  std::size_t bytes = 0;
  for (int round = 0; round < 3'000; ++round) {
    const int journey = index.AddJourney(absl::StrCat("robots/r/journeys/", round), {});
    JourneyStep recorded;
    for (int landmark = 0; landmark < 10; ++landmark) {
      recorded.fingerprints.push_back({Side::kLeft, {1.0F, 2.0F, 3, landmark}, 0});
    }
    index.Append(journey, recorded);
    index.Remove(journey);
    index.Sweep(64);
    if (round == 100) bytes = index.MemoryBytes();
  }
  EXPECT_LT(index.journey_count(), 10);
  EXPECT_EQ(index.MemoryBytes(), bytes);
}

}  // namespace
}  // namespace homing
