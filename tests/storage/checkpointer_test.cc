// The log of an open store is moved into the file while it is written, and begins anew.
#include "storage/checkpointer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

// Each transaction changes a page of each journey.
class CheckpointerTest : public ::testing::Test {
 protected:
  static constexpr int kMany = 1000;
  static std::string Name(int journey) {
    return "robots/r" + std::to_string(journey) + "/journeys/j";
  }
  void SetUp() override {
    for (int i = 0; i < kMany; ++i) {
      ASSERT_THAT(store_->CreateJourney(Record(Name(i))), IsOk());
    }
  }
  void Append(int transactions) {
    for (int i = 0; i < transactions; ++i, ++done_) {
      std::vector<JourneyAppend> appends;
      for (int journey = 0; journey < kMany; ++journey) {
        appends.push_back(AppendOf(Name(journey), steps_[static_cast<std::size_t>(done_)]));
      }
      for (const absl::Status& status : store_->AppendSteps(appends)) ASSERT_THAT(status, IsOk());
    }
  }
  // Most is in the file, though the store is open.
  bool MovedInTime() const {
    const auto file = folder_.File("homing.db");
    for (int i = 0; i < 1000; ++i) {
      if (std::filesystem::file_size(file) > 1'000'000) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
  std::uintmax_t LogBytes() const {
    return std::filesystem::file_size(folder_.File("homing.db-wal"));
  }

  const std::vector<JourneyStep> steps_ = MakeSteps(100);
  const TemporaryFolder folder_;
  std::unique_ptr<JourneyStore> store_ = OpenOrDie(folder_.Database());
  int done_ = 0;
};

TEST_F(CheckpointerTest, TheLogIsMovedWhileTheStoreIsOpenAndBeginsAnew) {
  EXPECT_LT(std::filesystem::file_size(folder_.File("homing.db")), 1'000'000U);
  Append(40);
  ASSERT_TRUE(MovedInTime());
  Append(60);
  // Without a new beginning it is two or three times as long.
  EXPECT_LT(LogBytes(), 250'000'000U);
  for (const int journey : {0, kMany / 2, kMany - 1}) {
    EXPECT_TRUE(SameMap(*store_->LoadMap(Name(journey)), MapOf(OddSettings(), steps_)));
  }
  store_.reset();
  EXPECT_FALSE(std::filesystem::exists(folder_.File("homing.db-wal")));
}

TEST_F(CheckpointerTest, AReaderThatStaysHoldsUpTheLogAndNothingElse) {
  Append(2);
  auto reader =
      Connection::Open(folder_.File("homing.db"), Connection::Access::kReadOnly, kBusyTimeoutMs);
  ASSERT_THAT(reader, IsOk());
  ASSERT_THAT((*reader)->Read([&] {
    EXPECT_EQ((*reader)->Integer("SELECT max(step_count) FROM journeys"), 2);
    Append(30);
    EXPECT_EQ((*reader)->Integer("SELECT max(step_count) FROM journeys"), 2);
    return absl::OkStatus();
  }),
              IsOk());
  Append(2);
  EXPECT_EQ(store_->GetJourney(Name(7))->step_count, 34);
}

}  // namespace
}  // namespace homing::storage
