// A real disk without space, of memory: mounting it takes root.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <fstream>

#include "storage/space_reserve.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

constexpr char kOther[] = "robots/r/journeys/other";

class FullDiskTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=12m") != 0) {
      GTEST_SKIP() << "SKIPPED: a disk can be mounted by root alone";
    }
    mounted_ = true;
  }
  void TearDown() override {
    if (mounted_) ::umount2(disk_.c_str(), MNT_DETACH);
  }
  // The disk is full to the last block.
  void Fill() {
    std::ofstream ballast(disk_ + "/ballast", std::ios::binary | std::ios::app);
    const std::string block(4096, 'x');
    while (ballast.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
    }
  }
  static absl::Status AppendHundred(JourneyStore& store, const char* journey, StepMaker* maker) {
    std::vector<JourneyAppend> appends;
    appends.reserve(100);
    for (int i = 0; i < 100; ++i) appends.push_back(AppendOf(journey, maker->Next()));
    return store.AppendSteps(appends)[0];
  }

  TemporaryFolder folder_;
  const std::string disk_ = [this] {
    std::filesystem::create_directory(folder_.File("disk"));
    return folder_.File("disk");
  }();
  const std::string url_ = "sqlite:" + disk_ + "/homing.db";
  const std::string reserve_ = disk_ + "/homing.db-reserve";
  bool mounted_ = false;
};

TEST_F(FullDiskTest, AJourneyCanBeDeletedAndRecordingGoesOn) {
  auto store = OpenOrDie(url_);
  EXPECT_GE(std::filesystem::file_size(reserve_), 2U << 20);
  StepMaker maker, other;
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  ASSERT_THAT(store->CreateJourney(Record(kOther)), IsOk());
  for (int i = 0; i < 30; ++i) ASSERT_THAT(AppendHundred(*store, kJourney, &maker), IsOk());
  std::int64_t stored = 0;
  Fill();
  absl::Status status;
  for (; status.ok() && stored < 100'000; stored += status.ok() ? 100 : 0) {
    status = AppendHundred(*store, kOther, &other);
  }
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("full")));
  EXPECT_FALSE(store->ProbeWrite().ok());

  EXPECT_THAT(store->DeleteJourney(kJourney), IsOk());
  EXPECT_THAT(store->GetJourney(kJourney), StatusIs(absl::StatusCode::kNotFound, HasSubstr("")));
  EXPECT_THAT(store->ProbeWrite(), IsOk());
  EXPECT_TRUE(std::filesystem::exists(reserve_));
  StepMaker again;
  for (std::int64_t i = 0; i < stored; i += 100) {
    for (int k = 0; k < 100; ++k) again.Next();
  }
  for (int i = 0; i < 10; ++i) EXPECT_THAT(AppendHundred(*store, kOther, &again), IsOk());
  const auto map = store->LoadMap(kOther);
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(map->step_count(), stored + 1000);
  store.reset();
  EXPECT_FALSE(std::filesystem::exists(reserve_));
}

TEST_F(FullDiskTest, AJourneyLargerThanTheReserveCanBeDeleted) {
  auto store = OpenOrDie(url_);
  StepMaker maker;
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  absl::Status status;
  while (status.ok()) status = AppendHundred(*store, kJourney, &maker);
  ASSERT_GT(std::filesystem::file_size(disk_ + "/homing.db"),
            std::filesystem::file_size(reserve_) * 3 / 2);
  Fill();
  EXPECT_THAT(store->DeleteJourney(kJourney), IsOk());
  EXPECT_THAT(store->GetJourney(kJourney), StatusIs(absl::StatusCode::kNotFound, HasSubstr("")));
  StepMaker other;
  ASSERT_THAT(store->CreateJourney(Record(kOther)), IsOk());
  for (int i = 0; i < 50; ++i) ASSERT_THAT(AppendHundred(*store, kOther, &other), IsOk());
}

TEST_F(FullDiskTest, AServerThatWasKilledStartsAgain) {
  {
    auto store = OpenOrDie(url_);
    ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  }
  std::ofstream(reserve_) << std::string(1 << 20, 'x');
  Fill();
  auto store = OpenOrDie(url_);
  EXPECT_THAT(store->DeleteJourney(kJourney), IsOk());
}

TEST_F(FullDiskTest, OneOfTheJourneysThatFilledTheDiskCanBeDeleted) {
  auto store = OpenOrDie(url_);
  absl::Status status;
  int journeys = 0;
  for (; status.ok(); ++journeys) {
    const std::string name = "robots/r/journeys/" + std::to_string(journeys);
    StepMaker maker;
    status = store->CreateJourney(Record(name));
    for (int i = 0; i < 30 && status.ok(); ++i) {
      status = AppendHundred(*store, name.c_str(), &maker);
    }
  }
  ASSERT_GT(journeys, 5);
  EXPECT_THAT(store->DeleteJourney("robots/r/journeys/0"), IsOk());
  StepMaker other;
  ASSERT_THAT(store->CreateJourney(Record(kOther)), IsOk());
  for (int i = 0; i < 20; ++i) EXPECT_THAT(AppendHundred(*store, kOther, &other), IsOk());
}

TEST_F(FullDiskTest, ADeletionThatStillFindsNoRoomSaysSoAndDamagesNothing) {
  constexpr std::size_t kSpare = 6 << 20;
  std::ofstream(disk_ + "/spare") << std::string(kSpare, 'x');
  auto store = OpenOrDie(url_);
  StepMaker maker;
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  absl::Status status;
  std::int64_t stored = 0;
  for (; status.ok(); stored += status.ok() ? 100 : 0) {
    status = AppendHundred(*store, kJourney, &maker);
  }
  // Somebody else takes the space that was kept.
  std::filesystem::remove(reserve_);
  std::ofstream(reserve_).close();
  Fill();
  EXPECT_THAT(store->DeleteJourney(kJourney),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("free some space")));
  const auto map = store->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(map->step_count(), stored);
  std::filesystem::remove(disk_ + "/spare");
  EXPECT_THAT(store->DeleteJourney(kJourney), IsOk());
}

}  // namespace
}  // namespace homing::storage
