// The doctor's findings and salvage for complete, cut and changed files.
#include "storage/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "storage/connection.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr int kJourneys = 6;
constexpr int kSteps = 300;
constexpr std::uintmax_t kPage = 4096;

std::string NameOf(int journey) { return "robots/r/journeys/" + std::to_string(journey); }

class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest() {
    auto store = OpenOrDie(folder_.Database());
    for (int i = 0; i < kJourneys; ++i) {
      EXPECT_THAT(store->CreateJourney(Record(NameOf(i))), IsOk());
      std::vector<JourneyAppend> appends;
      for (const JourneyStep& step : steps_) appends.push_back(AppendOf(NameOf(i), step));
      for (const absl::Status& status : store->AppendSteps(appends)) EXPECT_THAT(status, IsOk());
    }
    EXPECT_THAT(store->FinishJourney(NameOf(0)), IsOk());
    StoredModel model;
    model.name = "deviationModels/m";
    EXPECT_THAT(store->CreateModel(model), IsOk());
  }

  void Overwrite(std::uintmax_t at, const std::string& bytes) const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(at));
    file << bytes;
  }
  std::string Bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  int CountFiles() const {
    int count = 0;
    for ([[maybe_unused]] const auto& file :
         std::filesystem::directory_iterator(std::filesystem::path(path_).parent_path())) {
      ++count;
    }
    return count;
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.File("homing.db");
  const std::string saved_ = folder_.File("saved.db");
  const std::vector<JourneyStep> steps_ = WithProfiles(MakeSteps(kSteps));
};

TEST_F(DoctorTest, AWholeFileIsWholeAndIsNotTouched) {
  const std::string before = Bytes();
  const int files = CountFiles();
  const auto diagnosis = Examine(path_);
  ASSERT_THAT(diagnosis, IsOk());
  EXPECT_TRUE(IsWhole(*diagnosis));
  EXPECT_THAT(diagnosis->journeys, SizeIs(kJourneys));
  EXPECT_EQ(diagnosis->journeys[0].step_count, kSteps);
  EXPECT_THAT(diagnosis->models, SizeIs(1));
  EXPECT_TRUE(Bytes() == before);
  EXPECT_EQ(CountFiles(), files);
}

TEST_F(DoctorTest, SalvageKeepsAllOfAWholeFile) {
  ASSERT_THAT(Salvage(path_, saved_), IsOk());
  auto from = OpenOrDie(folder_.Database());
  auto to = OpenOrDie("sqlite:" + saved_);
  for (int i = 0; i < kJourneys; ++i) {
    EXPECT_TRUE(SameMap(*to->LoadMap(NameOf(i)), *from->LoadMap(NameOf(i))));
    const auto before = from->GetJourney(NameOf(i));
    const auto after = to->GetJourney(NameOf(i));
    EXPECT_EQ(after->state, before->state);
    EXPECT_EQ(after->next_sequence, before->next_sequence);
    EXPECT_EQ(after->writer_id, before->writer_id);
    EXPECT_EQ(after->input, before->input);
    EXPECT_EQ(after->create_time_ns, before->create_time_ns);
    EXPECT_EQ(after->readers, before->readers);
  }
  EXPECT_THAT(to->GetModel("deviationModels/m"), IsOk());
  // Recording continues.
  JourneyStep next = MakeSteps(kSteps + 1).back();
  EXPECT_THAT(to->AppendSteps({AppendOf(NameOf(1), next)})[0], IsOk());
}

TEST_F(DoctorTest, OneDamagedJourneyDoesNotTakeTheOthersAlong) {
  {
    auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
    ASSERT_THAT((*connection)->Run([&] {
      (*connection)->Execute("DELETE FROM steps WHERE journey_id = 3 AND step = 7");
      return absl::OkStatus();
    }),
                IsOk());
  }
  const auto diagnosis = Salvage(path_, saved_);
  ASSERT_THAT(diagnosis, IsOk());
  EXPECT_FALSE(IsWhole(*diagnosis));
  EXPECT_EQ(CountDamaged(diagnosis->journeys), 1);
  auto store = OpenOrDie("sqlite:" + saved_);
  EXPECT_THAT(*store->ListJourneys("robots/", "", 100), SizeIs(kJourneys - 1));
}

TEST_F(DoctorTest, ValuesThatNoServerWritesAreDamage) {
  const std::string original = path_ + ".original";
  std::filesystem::copy_file(path_, original);
  for (const char* change :
       {"UPDATE journeys SET name = 'text' WHERE journey_id = 3",
        "UPDATE journeys SET name = 'robots//journeys/x' WHERE journey_id = 3",
        "UPDATE journeys SET next_sequence = 0 WHERE journey_id = 3",
        "UPDATE journeys SET create_time_ns = -1 WHERE journey_id = 3",
        "UPDATE deviation_models SET name = 'm'", "UPDATE deviation_models SET mu = 1e9",
        "UPDATE deviation_models SET sigma = -1",
        "UPDATE deviation_models SET observations = observations + 4294967296",
        "UPDATE deviation_models SET ks_distance = 2", "UPDATE deviation_models SET width = -1",
        "UPDATE deviation_models SET create_time_ns = -1"}) {
    std::filesystem::copy_file(original, path_, std::filesystem::copy_options::overwrite_existing);
    {
      auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
      ASSERT_THAT((*connection)->Run([&] {
        (*connection)->Execute("PRAGMA ignore_check_constraints = 1");
        (*connection)->Execute(change);
        return absl::OkStatus();
      }),
                  IsOk())
          << change;
    }
    const auto diagnosis = Examine(path_);
    ASSERT_THAT(diagnosis, IsOk()) << change;
    EXPECT_EQ(CountDamaged(diagnosis->journeys) + CountDamaged(diagnosis->models), 1) << change;
  }
}

TEST_F(DoctorTest, ATruncatedFileIsReportedAndCompleteJourneysAreSaved) {
  const auto size = std::filesystem::file_size(path_);
  for (const std::uintmax_t share : {9u, 7u, 5u, 3u}) {
    std::filesystem::remove(saved_);
    std::filesystem::resize_file(path_, size * share / 10 / kPage * kPage);
    const auto diagnosis = Salvage(path_, saved_);
    if (!diagnosis.ok()) continue;
    EXPECT_FALSE(IsWhole(*diagnosis)) << share;
    EXPECT_THAT(diagnosis->problems, Not(IsEmpty()));
    auto store = OpenOrDie("sqlite:" + saved_);
    const auto listed = store->ListJourneys("robots/", "", 100);
    ASSERT_THAT(listed, IsOk());
    for (const JourneyRecord& record : *listed) {
      EXPECT_TRUE(SameMap(*store->LoadMap(record.name), MapOf(OddSettings(), steps_)));
    }
  }
}

// Wherever they are. (A flipped bit of a stored number is a number: only pages and sums are
// checked.)
TEST_F(DoctorTest, FlippedBitsCrashNothing) {
  const std::string original = Bytes();
  std::mt19937 random(3);
  int saved_journeys = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::string damaged = original;
    for (int i = 0; i < 1 + trial / 4; ++i) {
      damaged[random() % damaged.size()] ^= static_cast<char>(1 << (random() % 8));
    }
    Overwrite(0, damaged);
    std::filesystem::remove(saved_);
    if (!Salvage(path_, saved_).ok()) continue;
    auto store = OpenOrDie("sqlite:" + saved_);
    saved_journeys += static_cast<int>(store->ListJourneys("", "", 100)->size());
  }
  EXPECT_GT(saved_journeys, 0);
}

TEST_F(DoctorTest, AFileThatIsNoDatabaseIsReported) {
  std::ofstream(path_) << std::string(8192, 'x');
  EXPECT_THAT(Examine(path_), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("not a database")));
  EXPECT_THAT(Examine(folder_.File("none.db")),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("unable to open")));
}

TEST_F(DoctorTest, SalvageNeverReplacesAFile) {
  std::ofstream{saved_} << "mine";
  EXPECT_THAT(Salvage(path_, saved_),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("saved.db")));
}

TEST_F(DoctorTest, ItSeesAStoreInUseAsItIs) {
  auto store = OpenOrDie(folder_.Database());
  ASSERT_THAT(store->CreateJourney(Record(NameOf(99))), IsOk());
  const auto diagnosis = Examine(path_);
  ASSERT_THAT(diagnosis, IsOk());
  EXPECT_TRUE(IsWhole(*diagnosis));
  EXPECT_THAT(diagnosis->journeys, SizeIs(kJourneys + 1));
}

}  // namespace
}  // namespace homing::storage
