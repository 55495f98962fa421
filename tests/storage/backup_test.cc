// Backups of a store in use and at rest.
#include "storage/backup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

class BackupTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  const std::string path_ = folder_.File("homing.db");
  const std::string copy_ = folder_.File("copy.db");
};

// Every copy is the store as of some moment between two commits.
TEST_F(BackupTest, ACopyTakenWhileAWriterWritesIsWhole) {
  auto store = OpenOrDie(folder_.Database());
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  const std::vector<JourneyStep> steps = MakeSteps(3000);
  std::atomic<bool> stop = false;
  std::atomic<std::size_t> stored = 0;
  std::thread writer([&] {
    while (!stop && stored < steps.size()) {
      EXPECT_THAT(store->AppendSteps({AppendOf(kJourney, steps[stored])})[0], IsOk());
      ++stored;
    }
  });
  for (int i = 0; i < 5; ++i) {
    const std::size_t before = stored;
    const std::string copy = copy_ + std::to_string(i);
    EXPECT_THAT(BackUp(path_, copy), IsOk());
    auto restored = OpenOrDie("sqlite:" + copy);
    const auto map = restored->LoadMap(kJourney);
    ASSERT_THAT(map, IsOk());
    const auto count = static_cast<std::ptrdiff_t>(map->step_count());
    EXPECT_GE(count, static_cast<std::ptrdiff_t>(before));
    EXPECT_TRUE(SameMap(*map, MapOf(OddSettings(), {steps.begin(), steps.begin() + count})));
  }
  stop = true;
  writer.join();
}

TEST_F(BackupTest, ARestoredCopyContinues) {
  const std::vector<JourneyStep> steps = MakeSteps(50);
  {
    auto store = OpenOrDie(folder_.Database());
    ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
    AppendAll(*store, kJourney, {steps.begin(), steps.begin() + 30});
    ASSERT_THAT(BackUp(path_, copy_), IsOk());
    AppendAll(*store, kJourney, {steps.begin() + 30, steps.end()});
  }
  std::filesystem::rename(copy_, path_);
  auto store = OpenOrDie(folder_.Database());
  AppendAll(*store, kJourney, {steps.begin() + 30, steps.end()});
  EXPECT_TRUE(SameMap(*store->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

TEST_F(BackupTest, LeavesNothingBesideTheCopy) {
  OpenOrDie(folder_.Database());
  ASSERT_THAT(BackUp(path_, copy_), IsOk());
  for (const char* end : {".partial", "-wal", "-shm", ".partial-journal", ".partial-wal"}) {
    EXPECT_FALSE(std::filesystem::exists(copy_ + end)) << end;
  }
  for (const char* end : {"-wal", "-shm"}) {
    EXPECT_FALSE(std::filesystem::exists(path_ + end)) << end;
  }
}

TEST_F(BackupTest, NeverReplacesAFileAndSaysWhyItFails) {
  EXPECT_THAT(BackUp(path_, copy_),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("unable to open")));
  EXPECT_FALSE(std::filesystem::exists(copy_));
  OpenOrDie(folder_.Database());
  EXPECT_THAT(BackUp(path_, folder_.File("none/copy.db")),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("unable to open")));
  std::ofstream{copy_} << "mine";
  EXPECT_THAT(BackUp(path_, copy_), StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("copy")));
  EXPECT_EQ(std::filesystem::file_size(copy_), 4U);
}

}  // namespace
}  // namespace homing::storage
