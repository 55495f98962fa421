// Damaged files, contradicting rows, a full disk, a locked file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>

#include "storage/connection.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

StoreOptions OptionsOf(const std::string& url) {
  StoreOptions options;
  options.url = url;
  options.busy_timeout_ms = 20;
  return options;
}

class DamageTest : public ::testing::Test {
 protected:
  // A closed file with one journey of `steps` steps.
  void MakeFile(int steps) {
    auto store = OpenOrDie(folder_.Database());
    ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
    std::vector<JourneyAppend> appends;
    for (const JourneyStep& step : MakeSteps(steps)) appends.push_back(AppendOf(kJourney, step));
    for (const absl::Status& status : store->AppendSteps(appends)) ASSERT_THAT(status, IsOk());
  }
  void Execute(const std::string& sql) {
    auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
    ASSERT_THAT(connection, IsOk());
    ASSERT_THAT((*connection)->Run([&] {
      (*connection)->Execute(sql);
      return absl::OkStatus();
    }),
                IsOk());
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.File("homing.db");
};

TEST_F(DamageTest, AFileThatIsNoDatabaseIsDataLoss) {
  std::ofstream(path_) << std::string(8192, 'x');
  EXPECT_THAT(OpenJourneyStore(OptionsOf(folder_.Database())),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("not a database")));
}

TEST_F(DamageTest, OverwrittenPagesAreDataLossAndNoCrash) {
  MakeFile(500);
  const auto size = std::filesystem::file_size(path_);
  ASSERT_GT(size, 10 * 4096U);
  {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4096 * 4);
    for (auto at = 4096U * 4; at < size; ++at) file.put(static_cast<char>(at * 7));
  }
  auto store = OpenJourneyStore(OptionsOf(folder_.Database()));
  ASSERT_THAT(store, IsOk());
  EXPECT_THAT((*store)->LoadMap(kJourney), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")));
}

TEST_F(DamageTest, ATruncatedFileIsDataLoss) {
  MakeFile(500);
  std::filesystem::resize_file(path_, 4096 * 5);
  auto store = OpenJourneyStore(OptionsOf(folder_.Database()));
  const absl::Status status = store.ok() ? (*store)->LoadMap(kJourney).status() : store.status();
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")));
}

TEST_F(DamageTest, RowsThatContradictEachOtherAreDataLoss) {
  MakeFile(30);
  const std::vector<std::string> changes = {
      "DELETE FROM steps WHERE step = 7",
      "UPDATE steps SET left1_landmark = NULL WHERE step = 7",
      "UPDATE steps SET left1_landmark = right1_landmark WHERE step = 3",
      "UPDATE steps SET left1_landmark = 2, right1_landmark = 0 WHERE step = 0",
      "UPDATE steps SET step_id = step_id + 100 WHERE step = 29",
      "UPDATE steps SET left1_spread = -1 WHERE step = 3",
      "UPDATE steps SET left1_landmark = 5000 WHERE step = 3",
      "UPDATE steps SET left1_landmark = -1 WHERE step = 3",
      "UPDATE steps SET left1_landmark = left1_landmark + 4294967296 WHERE step = 3",
      "UPDATE steps SET right1_count = 0 WHERE step = 3",
      "UPDATE steps SET right1_x = 1e300 WHERE step = 3",
      "UPDATE steps SET left_profile = x'010203' WHERE step = 3",
      "UPDATE steps SET sequence = -1 WHERE step = 3",
      "UPDATE journeys SET step_count = 5",
      "UPDATE journeys SET step_count = -1",
      "UPDATE journeys SET step_count = 1000000000000",
      "UPDATE journeys SET fingerprint_count = 5",
      "UPDATE journeys SET landmark_count = 5",
      "UPDATE journeys SET landmark_count = 5000",
      "UPDATE journeys SET landmark_count = landmark_count + 4294967296",
      "UPDATE journeys SET next_sequence = -1",
      "UPDATE journeys SET next_sequence = 29",
      "UPDATE journeys SET resend_from = -1",
      "UPDATE journeys SET resend_from = next_sequence + 1",
      "UPDATE journeys SET create_time_ns = -1",
      "UPDATE journeys SET start_time_ns = -1",
      "UPDATE journeys SET end_time_ns = -1",
      "DELETE FROM journey_settings",
      "UPDATE journey_settings SET settings = '{}'",
      "UPDATE journey_settings SET settings = 'nonsense'",
      "UPDATE journeys SET readers = '[1]'"};
  const std::string original = path_ + ".original";
  std::filesystem::copy_file(path_, original);
  for (const std::string& change : changes) {
    std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
    Execute(change);
    EXPECT_THAT(OpenOrDie(folder_.Database())->LoadMap(kJourney),
                StatusIs(absl::StatusCode::kDataLoss, HasSubstr("store")))
        << change;
  }
}

TEST_F(DamageTest, OneDamagedJourneyDoesNotHideTheOthers) {
  MakeFile(3);
  {
    auto store = OpenOrDie(folder_.Database());
    JourneyRecord other = Record("robots/r2/journeys/b");
    other.readers = {"*"};
    ASSERT_THAT(store->CreateJourney(other), IsOk());
  }
  for (const char* change :
       {"UPDATE journeys SET readers = '[' WHERE journey_id = 1",
        "UPDATE journey_settings SET settings = 'nonsense' WHERE journey_id = 1"}) {
    Execute(change);
    auto store = OpenOrDie(folder_.Database());
    const auto listed = store->ListJourneys("robots/", "", 10);
    ASSERT_THAT(listed, IsOk()) << change;
    ASSERT_EQ(listed->size(), 2U);
    EXPECT_EQ(listed->front().name, kJourney);
    EXPECT_EQ(listed->front().step_count, 3);
    EXPECT_TRUE(listed->front().readers.empty());
    EXPECT_EQ(listed->back().readers.size(), 1U);
    EXPECT_THAT(store->GetJourney(kJourney), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")));
  }
}

TEST_F(DamageTest, ATailThatContradictsItselfIsDataLoss) {
  MakeFile(30);
  const std::string original = path_ + ".original";
  std::filesystem::copy_file(path_, original);
  for (const std::string change :
       {"UPDATE steps SET left1_landmark = 5000", "UPDATE steps SET right_profile = x'010203'",
        "UPDATE journeys SET step_count = 29", "UPDATE journeys SET step_count = -1",
        "UPDATE journeys SET step_count = 1000000000000"}) {
    std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
    Execute(change);
    EXPECT_THAT(OpenOrDie(folder_.Database())->LoadTail(kJourney),
                StatusIs(absl::StatusCode::kDataLoss, HasSubstr("store")))
        << change;
  }
}

TEST_F(DamageTest, AFullDiskIsReportedAndStoresNoHalves) {
  auto store = OpenOrDie(folder_.Database(), 200 * 1024);
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  StepMaker maker;
  absl::Status status;
  std::int64_t stored = 0;
  while (status.ok() && stored < 100'000) {
    std::vector<JourneyAppend> appends;
    for (int i = 0; i < 50; ++i) appends.push_back(AppendOf(kJourney, maker.Next()));
    const auto statuses = store->AppendSteps(appends);
    status = statuses[0];
    for (const absl::Status& other : statuses) EXPECT_EQ(other, status);
    if (status.ok()) stored += 50;
  }
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("full")));
  const auto map = store->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  EXPECT_TRUE(SameMap(*map, MapOf(OddSettings(), MakeSteps(static_cast<int>(stored)))));
  EXPECT_THAT(store->WriteHealth(), StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("")));
  // Room again.
  ASSERT_THAT(store->DeleteJourney(kJourney), IsOk());
  ASSERT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
  AppendAll(*store, kJourney, MakeSteps(10));
  EXPECT_THAT(store->WriteHealth(), IsOk());
}

TEST_F(DamageTest, AFileThatAnotherProcessKeepsLockedIsUnavailable) {
  MakeFile(1);
  auto store = OpenJourneyStore(OptionsOf(folder_.Database()));
  ASSERT_THAT(store, IsOk());
  auto other = Connection::Open(path_, Connection::Access::kReadWrite, 20);
  ASSERT_THAT(other, IsOk());
  ASSERT_THAT((*other)->Write([&] {
    EXPECT_THAT((*store)->FinishJourney(kJourney),
                StatusIs(absl::StatusCode::kUnavailable, HasSubstr("locked")));
    EXPECT_THAT((*store)->LoadMap(kJourney), IsOk());
    return absl::OkStatus();
  }),
              IsOk());
  EXPECT_FALSE((*store)->WriteHealth().ok());
  EXPECT_THAT((*store)->ProbeWrite(), IsOk());
  EXPECT_THAT((*store)->FinishJourney(kJourney), IsOk());
}

TEST_F(DamageTest, ARefusalIsNoFaultOfTheStore) {
  MakeFile(1);
  auto store = OpenOrDie(folder_.Database());
  EXPECT_FALSE(store->DeleteJourney("robots/r/journeys/none").ok());
  EXPECT_FALSE(store->CreateJourney(Record(kJourney)).ok());
  EXPECT_THAT(store->WriteHealth(), IsOk());
}

}  // namespace
}  // namespace homing::storage
