// A store that may not be changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "storage/connection.h"
#include "storage/schema.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ReadOnlyTest : public ::testing::Test {
 protected:
  ReadOnlyTest() {
    auto store = OpenOrDie(folder_.Database());
    EXPECT_THAT(store->CreateJourney(Record(kJourney)), IsOk());
    AppendAll(*store, kJourney, steps_);
  }

  absl::StatusOr<std::unique_ptr<JourneyStore>> Open() const {
    StoreOptions options;
    options.url = folder_.Database();
    options.read_only = true;
    return OpenJourneyStore(options);
  }
  // Every file of the folder, with its bytes and the time it was changed.
  std::map<std::string, std::pair<std::string, fs::file_time_type>> Files() const {
    std::map<std::string, std::pair<std::string, fs::file_time_type>> files;
    for (const auto& entry : fs::directory_iterator(fs::path(path_).parent_path())) {
      std::ifstream file(entry.path(), std::ios::binary);
      files[entry.path().filename()] = {std::string(std::istreambuf_iterator<char>(file), {}),
                                        entry.last_write_time()};
    }
    return files;
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.File("homing.db");
  const std::vector<JourneyStep> steps_ = MakeSteps(40);
};

TEST_F(ReadOnlyTest, ReadsAllAndChangesNoByteAndNoFile) {
  const auto before = Files();
  {
    auto store = Open();
    ASSERT_THAT(store, IsOk());
    EXPECT_TRUE((*store)->read_only());
    EXPECT_TRUE(SameMap(*(*store)->LoadMap(kJourney), MapOf(OddSettings(), steps_)));
    EXPECT_EQ((*store)->ListJourneys("robots/", "", 10)->size(), 1U);
    EXPECT_TRUE(Files() == before) << "while it is open";
  }
  EXPECT_TRUE(Files() == before) << "after it was closed";
}

TEST_F(ReadOnlyTest, RefusesEveryWrite) {
  auto store = Open();
  ASSERT_THAT(store, IsOk());
  const auto refused = StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("read-only"));
  EXPECT_THAT((*store)->CreateJourney(Record("robots/r/journeys/k")), refused);
  EXPECT_THAT((*store)->DeleteJourney(kJourney), refused);
  EXPECT_THAT((*store)->FinishJourney(kJourney), refused);
  EXPECT_THAT((*store)->AcquireJourney(kJourney, "w"), refused);
  EXPECT_THAT((*store)->SetReaders(kJourney, {"*"}), refused);
  EXPECT_THAT((*store)->AppendSteps({AppendOf(kJourney, steps_[0])})[0], refused);
  EXPECT_THAT((*store)->CreateModel({}), refused);
  EXPECT_THAT((*store)->ProbeWrite(), IsOk());
}

TEST_F(ReadOnlyTest, ManyMayReadButNotBesideAWriter) {
  {
    auto one = Open();
    EXPECT_THAT(one, IsOk());
    EXPECT_THAT(Open(), IsOk());
    EXPECT_THAT(OpenJourneyStore({.url = folder_.Database()}),
                StatusIs(absl::StatusCode::kUnavailable, HasSubstr("in use")));
  }
  auto writer = OpenOrDie(folder_.Database());
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("in use")));
}

TEST_F(ReadOnlyTest, ALogThatIsNotInTheFileIsRefused) {
  std::ofstream(path_ + "-wal") << "something";
  EXPECT_THAT(Open(),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("not closed cleanly")));
}

TEST_F(ReadOnlyTest, AnOlderOrNewerSchemaIsRefusedAndLeft) {
  for (const std::int64_t version : {kSchemaVersion - 1, kSchemaVersion + 1}) {
    {
      auto connection = Connection::Open(path_, Connection::Access::kReadWrite, 100);
      ASSERT_THAT((*connection)->Run([&] {
        (*connection)->Execute("PRAGMA user_version=" + std::to_string(version));
        return absl::OkStatus();
      }),
                  IsOk());
    }
    const auto before = Files();
    EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kFailedPrecondition,
                                 HasSubstr(version < kSchemaVersion ? "older" : "newer")));
    EXPECT_TRUE(Files() == before);
  }
}

TEST_F(ReadOnlyTest, AMissingFileIsReportedAndNotCreated) {
  StoreOptions options;
  options.url = "sqlite:" + folder_.File("none.db");
  options.read_only = true;
  EXPECT_THAT(OpenJourneyStore(options),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("unable to open")));
  EXPECT_FALSE(fs::exists(folder_.File("none.db")));
}

TEST_F(ReadOnlyTest, APathWithSignsThatMeanSomethingInAUriIsOpened) {
  const std::string odd = folder_.File("a%b?c#d e\xc3\xa9.db");
  fs::copy_file(path_, odd);
  StoreOptions options;
  options.url = "sqlite:" + odd;
  options.read_only = true;
  const auto store = OpenJourneyStore(options);
  ASSERT_THAT(store, IsOk());
  EXPECT_THAT((*store)->LoadMap(kJourney), IsOk());
}

}  // namespace
}  // namespace homing::storage
