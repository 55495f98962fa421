// Bytes on disk for one fingerprint.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

// Of the closed (so checkpointed) file that `journeys` journeys of `steps` steps leave, recorded in
// turn, step by step, `batch` steps of each journey in a transaction.
double BytesPerFingerprint(int journeys, int steps, int batch) {
  const TemporaryFolder folder;
  std::int64_t fingerprints = 0;
  {
    auto store = OpenOrDie(folder.Database());
    std::vector<StepMaker> makers(static_cast<std::size_t>(journeys));
    std::vector<std::string> names;
    for (int j = 0; j < journeys; ++j) {
      names.push_back("robots/r/journeys/j" + std::to_string(j));
      EXPECT_THAT(store->CreateJourney(Record(names.back())), IsOk());
    }
    for (int done = 0; done < steps; done += batch) {
      std::vector<JourneyAppend> appends;
      for (std::size_t j = 0; j < names.size(); ++j) {
        for (int i = 0; i < batch; ++i) {
          appends.push_back(AppendOf(names[j], makers[j].Next()));
          fingerprints += static_cast<std::int64_t>(appends.back().step->fingerprints.size());
        }
      }
      for (const absl::Status& status : store->AppendSteps(appends)) EXPECT_THAT(status, IsOk());
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder.File("homing.db-wal")));
  const double bytes = static_cast<double>(std::filesystem::file_size(folder.File("homing.db")));
  return bytes / static_cast<double>(fingerprints);
}

TEST(StoreSize, AFingerprintOfAJourneyOfTenThousandStepsTakesAtMostFortyBytes) {
  const double bytes = BytesPerFingerprint(1, 10'000, 10);
  RecordProperty("bytes_per_fingerprint", std::to_string(bytes));
  EXPECT_LE(bytes, 40.0);
  // Smaller than its values: the measurement is wrong.
  EXPECT_GE(bytes, 16.0);
}

TEST(StoreSize, JourneysRecordedInTurnWasteLessThanHalfOfTheirPages) {
  const double bytes = BytesPerFingerprint(8, 1'200, 2);
  RecordProperty("bytes_per_fingerprint", std::to_string(bytes));
  EXPECT_LE(bytes, 60.0);
}

TEST(StoreSize, ACameraStepWithItsFlowProfileTakesAtMost180Bytes) {
  const TemporaryFolder folder;
  constexpr int kSteps = 4000;
  {
    auto store = OpenOrDie(folder.Database());
    EXPECT_THAT(store->CreateJourney(Record("robots/r/journeys/j")), IsOk());
    AppendAll(*store, "robots/r/journeys/j", WithProfiles(MakeSteps(kSteps)));
  }
  const double bytes = static_cast<double>(std::filesystem::file_size(folder.File("homing.db")));
  RecordProperty("bytes_per_camera_step", std::to_string(bytes / (2 * kSteps)));
  // Of these, 128 are the profile with its odometer reading.
  EXPECT_LE(bytes / (2 * kSteps), 180.0);
  EXPECT_GE(bytes / (2 * kSteps), 60.0);
}

}  // namespace
}  // namespace homing::storage
