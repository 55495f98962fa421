// Stores and steps for the tests of storage/.
#ifndef TESTS_STORAGE_STORE_FIXTURE_H_
#define TESTS_STORAGE_STORE_FIXTURE_H_

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "storage/journey_store.h"
#include "tests/support/temporary_folder.h"

namespace homing::storage {

inline constexpr char kJourney[] = "robots/r/journeys/j";

enum class StoreKind { kMemory, kFile, kPostgres };

// Runs for every kind of store. Without PostgreSQL its cases are skipped.
class EveryStore : public ::testing::TestWithParam<StoreKind> {
 protected:
  void SetUp() override;
  TemporaryFolder folder_;
  std::unique_ptr<JourneyStore> store_;
};

inline auto EveryKind() {
  return ::testing::Values(StoreKind::kMemory, StoreKind::kFile, StoreKind::kPostgres);
}
std::string KindName(const ::testing::TestParamInfo<StoreKind>& test);

// The store, which must open.
std::unique_ptr<JourneyStore> OpenOrDie(const std::string& url, std::int64_t max_bytes = 0);

// Unlike the defaults in every part.
JourneySettings OddSettings();
JourneyRecord Record(const std::string& name);

// Steps as a recorder makes them: two to four fingerprints each; a landmark lasts about
// `landmark_steps` steps. Deterministic.
class StepMaker {
 public:
  explicit StepMaker(int landmark_steps = 20) : landmark_steps_(landmark_steps) {}
  JourneyStep Next();

 private:
  struct Lane {
    std::int32_t landmark = -1;
    double spread = 0;
  };
  std::uint32_t Random();

  int landmark_steps_;
  std::uint32_t random_ = 12345;
  std::int64_t step_ = 0;
  std::int32_t landmarks_ = 0;
  // Left low x, left high x, right low x, right high x.
  Lane lanes_[4];
};

// Appends the step of sequence `sequence` (flow vectors: step = sequence).
JourneyAppend AppendOf(const std::string& journey, const JourneyStep& step);
// Same, one by one; all must be stored.
void AppendAll(JourneyStore& store, const std::string& journey,
               const std::vector<JourneyStep>& steps);
std::vector<JourneyStep> MakeSteps(int count);
// The map that JourneyMap makes from the steps.
JourneyMap MapOf(const JourneySettings& settings, const std::vector<JourneyStep>& steps);
// Adds flow profiles, unlike from step to step; some steps have none.
std::vector<JourneyStep> WithProfiles(std::vector<JourneyStep> steps);
// Same settings, steps, fingerprints, profiles and landmarks, to the bit.
bool SameMap(const JourneyMap& a, const JourneyMap& b);

}  // namespace homing::storage

#endif  // TESTS_STORAGE_STORE_FIXTURE_H_
