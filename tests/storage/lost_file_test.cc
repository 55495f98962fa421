// The file of a store is taken away, replaced, cut or damaged while it is open.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "storage/connection.h"
#include "storage/doctor.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

class LostFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    store_ = OpenOrDie(folder_.Database());
    ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
    ASSERT_THAT(Append(0), IsOk());
    EXPECT_THAT(store_->WriteHealth(), IsOk());
  }
  absl::Status Append(std::size_t step) {
    return store_->AppendSteps(
        {AppendOf(kJourney, MakeSteps(static_cast<int>(step) + 1)[step])})[0];
  }
  // Nothing is acknowledged, nothing is read, and health knows without a write.
  void ExpectLost(const std::string& what) {
    const auto lost = StatusIs(absl::StatusCode::kUnavailable, HasSubstr(what));
    EXPECT_THAT(store_->WriteHealth(), lost);
    EXPECT_THAT(Append(1), lost);
    EXPECT_THAT(store_->CreateJourney(Record("robots/r/journeys/other")), lost);
    EXPECT_THAT(store_->GetJourney(kJourney), lost);
    EXPECT_THAT(store_->ProbeWrite(), lost);
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.File("homing.db");
  const std::filesystem::path log_ = folder_.File("homing.db-wal");
  std::unique_ptr<JourneyStore> store_;
};

TEST_F(LostFileTest, ARemovedFileIsNoticed) {
  std::filesystem::remove(path_);
  ExpectLost("was removed");
}

TEST_F(LostFileTest, AReplacedFileIsNoticed) {
  std::filesystem::copy_file(path_, folder_.File("copy"));
  std::filesystem::rename(folder_.File("copy"), path_);
  ExpectLost("was replaced");
}

TEST_F(LostFileTest, ARemovedLogIsNoticed) {
  std::filesystem::remove(log_);
  ExpectLost("was removed");
}

TEST_F(LostFileTest, AReplacedLogIsNoticed) {
  std::filesystem::copy_file(log_, folder_.File("copy"));
  std::filesystem::rename(folder_.File("copy"), log_);
  ExpectLost("was replaced");
}

TEST_F(LostFileTest, ACutLogIsNoticed) {
  std::filesystem::resize_file(log_, 0);
  ExpectLost("was cut");
}

TEST_F(LostFileTest, ACutFileIsNoticed) {
  store_.reset();
  store_ = OpenOrDie(folder_.Database());
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  EXPECT_THAT(store_->WriteHealth(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("was cut")));
}

TEST_F(LostFileTest, ThatIsPutBackIsTakenAgain) {
  std::filesystem::rename(path_, folder_.File("aside"));
  EXPECT_FALSE(Append(1).ok());
  std::filesystem::rename(folder_.File("aside"), path_);
  EXPECT_THAT(store_->WriteHealth(), IsOk());
}

TEST_F(LostFileTest, AnotherProgramMayMoveTheLog) {
  auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
  ASSERT_THAT(connection, IsOk());
  ASSERT_THAT((*connection)->Run([&] {
    (*connection)->Integer("PRAGMA wal_checkpoint(TRUNCATE)");
    return absl::OkStatus();
  }),
              IsOk());
  ASSERT_EQ(std::filesystem::file_size(log_), 0U);
  EXPECT_THAT(store_->WriteHealth(), IsOk());
  EXPECT_THAT(Append(1), IsOk());
  EXPECT_THAT(store_->WriteHealth(), IsOk());
}

TEST_F(LostFileTest, DamageStaysUntilACheckPasses) {
  for (std::size_t step = 1; step < 400; ++step) ASSERT_THAT(Append(step), IsOk());
  store_.reset();
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::copy_file(path_, folder_.File("whole"));
  store_ = OpenOrDie(folder_.Database());
  {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(4096);
    file << std::string(size - 4096, '\x5a');
  }
  EXPECT_THAT(store_->LoadMap(kJourney), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")));
  EXPECT_TRUE(absl::IsDataLoss(store_->WriteHealth()));
  EXPECT_TRUE(absl::IsDataLoss(store_->ProbeWrite()));
  EXPECT_TRUE(absl::IsDataLoss(store_->WriteHealth()));
}

TEST_F(LostFileTest, ANullAmongAFingerprintsValuesIsDamage) {
  store_.reset();
  std::filesystem::copy_file(path_, folder_.File("whole"));
  for (const char* column :
       {"left1_landmark", "left1_x", "left1_y", "left1_count", "left1_spread"}) {
    std::filesystem::copy_file(folder_.File("whole"), path_,
                               std::filesystem::copy_options::overwrite_existing);
    {
      auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
      ASSERT_THAT(connection, IsOk());
      ASSERT_THAT((*connection)->Run([&] {
        (*connection)->Execute(std::string("UPDATE steps SET ") + column + " = NULL");
        return absl::OkStatus();
      }),
                  IsOk());
    }
    const auto diagnosis = Examine(path_);
    ASSERT_THAT(diagnosis, IsOk());
    EXPECT_EQ(CountDamaged(diagnosis->journeys), 1) << column;
    EXPECT_THAT(OpenOrDie(folder_.Database())->LoadMap(kJourney),
                StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")))
        << column;
  }
}

}  // namespace
}  // namespace homing::storage
