#include "client/robot/observation_file.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::robot {
namespace {

constexpr char kHeld[] = "robots/r/journeys/out";

class ObservationFileTest : public ::testing::Test {
 protected:
  ObservationFile Open(const std::string& journey = kHeld) {
    auto file = ObservationFile::Open(folder_.File("buffer"), journey);
    EXPECT_THAT(file.status(), IsOk());
    return *std::move(file);
  }

  static std::vector<StoredObservation> Numbered(std::int64_t first, std::int64_t end) {
    std::vector<StoredObservation> all;
    for (std::int64_t i = first; i < end; ++i) all.push_back({i, std::string(10, 'a')});
    return all;
  }

  static std::vector<std::int64_t> Numbers(const ObservationFile& file) {
    std::vector<std::int64_t> numbers;
    std::int64_t next = 0;
    while (true) {
      const auto found = file.Read(next);
      EXPECT_THAT(found.status(), IsOk());
      if (!found.ok() || !*found) return numbers;
      numbers.push_back((**found).sequence);
      next = (**found).sequence + 1;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(ObservationFileTest, KeepsObservationsOverARestart) {
  EXPECT_THAT(Open().Append(Numbered(3, 6)), IsOk());
  const ObservationFile again = Open();
  EXPECT_EQ(Numbers(again), (std::vector<std::int64_t>{3, 4, 5}));
  const auto extent = again.Measure();
  ASSERT_THAT(extent.status(), IsOk());
  EXPECT_EQ(extent->end, 6);
  EXPECT_EQ(extent->count, 3);
  EXPECT_EQ(extent->bytes, 30);
}

TEST_F(ObservationFileTest, DropsWhatIsDurableExceptTheReference) {
  ObservationFile file = Open();
  EXPECT_THAT(file.Append(Numbered(0, 6)), IsOk());
  EXPECT_EQ(*file.DropBefore(4, 1), 30);
  EXPECT_EQ(Numbers(file), (std::vector<std::int64_t>{1, 4, 5}));
}

TEST_F(ObservationFileTest, Renumbers) {
  ObservationFile file = Open();
  EXPECT_THAT(file.Append(Numbered(0, 4)), IsOk());
  EXPECT_THAT(file.Renumber(2, 1), IsOk());
  EXPECT_EQ(Numbers(file), (std::vector<std::int64_t>{0, 1, 3, 4}));
}

TEST_F(ObservationFileTest, AFileWithObservationsBelongsToOneJourney) {
  EXPECT_THAT(Open().Append(Numbered(0, 1)), IsOk());
  EXPECT_THAT(ObservationFile::Open(folder_.File("buffer"), "robots/r/journeys/other").status(),
              StatusIs(absl::StatusCode::kFailedPrecondition, ::testing::HasSubstr(kHeld)));
  EXPECT_EQ(*Open().DropBefore(1, 1), 10);
  Open("robots/r/journeys/other");
}

TEST_F(ObservationFileTest, OneProgramAtATime) {
  const ObservationFile first = Open();
  EXPECT_THAT(ObservationFile::Open(folder_.File("buffer"), kHeld).status(),
              StatusIs(absl::StatusCode::kFailedPrecondition, ::testing::HasSubstr("another")));
}

TEST_F(ObservationFileTest, AFolderThatIsMissingIsNamed) {
  EXPECT_THAT(ObservationFile::Open(folder_.File("no/buffer"), kHeld).status(),
              StatusIs(absl::StatusCode::kUnavailable, ::testing::HasSubstr("no/buffer")));
}

}  // namespace
}  // namespace homing::robot
