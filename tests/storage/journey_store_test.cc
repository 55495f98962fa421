// Journeys and deviation models as whole rows, on every kind of store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> NamesOf(const std::vector<JourneyRecord>& records) {
  std::vector<std::string> names;
  for (const JourneyRecord& record : records) names.push_back(record.name);
  return names;
}

using JourneyStoreTest = EveryStore;

TEST_P(JourneyStoreTest, GivesBackAJourneyAsCreated) {
  const JourneyRecord record = Record(kJourney);
  ASSERT_THAT(store_->CreateJourney(record), IsOk());
  const auto got = store_->GetJourney(kJourney);
  ASSERT_THAT(got, IsOk());
  EXPECT_EQ(got->name, record.name);
  EXPECT_TRUE(got->settings == record.settings);
  EXPECT_EQ(got->state, JourneyState::kActive);
  EXPECT_EQ(got->writer_id, "writer");
  EXPECT_EQ(got->readers, record.readers);
  EXPECT_EQ(got->input, InputKind::kUnknown);
  EXPECT_EQ(got->next_sequence, 0);
  EXPECT_EQ(got->create_time_ns, record.create_time_ns);
  EXPECT_EQ(got->start_time_ns, 0);
  EXPECT_EQ(got->end_time_ns, 0);
  EXPECT_EQ(got->step_count, 0);
}

TEST_P(JourneyStoreTest, RefusesASecondJourneyOfTheSameName) {
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  JourneyRecord other = Record(kJourney);
  other.writer_id = "other";
  EXPECT_THAT(store_->CreateJourney(other),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr(kJourney)));
  EXPECT_EQ(store_->GetJourney(kJourney)->writer_id, "writer");
}

TEST_P(JourneyStoreTest, NamesTheJourneyThatDoesNotExist) {
  const auto not_found = StatusIs(absl::StatusCode::kNotFound, HasSubstr(kJourney));
  EXPECT_THAT(store_->GetJourney(kJourney), not_found);
  EXPECT_THAT(store_->LoadMap(kJourney), not_found);
  EXPECT_THAT(store_->DeleteJourney(kJourney), not_found);
  EXPECT_THAT(store_->FinishJourney(kJourney), not_found);
  EXPECT_THAT(store_->AcquireJourney(kJourney, "w"), not_found);
  EXPECT_THAT(store_->LoadSteps(kJourney, 0), not_found);
  EXPECT_THAT(store_->LoadMarks({kJourney}).value(), IsEmpty());
  EXPECT_THAT(store_->SetReaders(kJourney, {}), not_found);
}

TEST_P(JourneyStoreTest, ListsInOrderOfNameFromWhereItLeftOff) {
  for (const char* name : {"robots/b/journeys/1", "robots/a/journeys/2", "robots/a/journeys/10",
                           "robots/ab/journeys/1"}) {
    ASSERT_THAT(store_->CreateJourney(Record(name)), IsOk());
  }
  const auto first = store_->ListJourneys("robots/", "", 2);
  ASSERT_THAT(first, IsOk());
  EXPECT_THAT(NamesOf(*first), ElementsAre("robots/a/journeys/10", "robots/a/journeys/2"));
  const auto rest = store_->ListJourneys("robots/", "robots/a/journeys/2", 10);
  ASSERT_THAT(rest, IsOk());
  EXPECT_THAT(NamesOf(*rest), ElementsAre("robots/ab/journeys/1", "robots/b/journeys/1"));
}

TEST_P(JourneyStoreTest, ListsOnlyTheNamesThatBeginWithThePrefix) {
  for (const char* name : {"robots/a/journeys/1", "robots/a-/journeys/1", "robots/a0/journeys/1"}) {
    ASSERT_THAT(store_->CreateJourney(Record(name)), IsOk());
  }
  EXPECT_THAT(NamesOf(*store_->ListJourneys("robots/a/", "", 10)),
              ElementsAre("robots/a/journeys/1"));
  EXPECT_THAT(*store_->ListJourneys("robots/a/", "", 0), IsEmpty());
  EXPECT_THAT(*store_->ListJourneys("robots/%", "", 10), IsEmpty());
}

TEST_P(JourneyStoreTest, FinishesAndChangesTheWriter) {
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  ASSERT_THAT(store_->AcquireJourney(kJourney, "second"), IsOk());
  ASSERT_THAT(store_->FinishJourney(kJourney), IsOk());
  EXPECT_THAT(store_->FinishJourney(kJourney), IsOk());
  EXPECT_EQ(store_->GetJourney(kJourney)->writer_id, "second");
  EXPECT_EQ(store_->GetJourney(kJourney)->state, JourneyState::kFinished);
}

TEST_P(JourneyStoreTest, ChangesTheReaders) {
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  const std::vector<std::string> readers = {"robots/b", "*"};
  ASSERT_THAT(store_->SetReaders(kJourney, readers), IsOk());
  EXPECT_EQ(store_->GetJourney(kJourney)->readers, readers);
  ASSERT_THAT(store_->SetReaders(kJourney, {}), IsOk());
  EXPECT_THAT(store_->GetJourney(kJourney)->readers, IsEmpty());
}

TEST_P(JourneyStoreTest, ANameCannotCarrySqlIntoTheStore) {
  const std::string name = "x'; DROP TABLE journeys; --";
  ASSERT_THAT(store_->CreateJourney(Record(name)), IsOk());
  EXPECT_EQ(store_->GetJourney(name)->name, name);
}

TEST_P(JourneyStoreTest, GivesBackDeviationModelsInOrderOfName) {
  StoredModel model;
  model.name = "deviationModels/wide";
  model.model = {2.1, 0.9, 500, 0.02, 640, 480};
  model.training.seed = 0xffffffffffffffffULL;
  model.training.focal_px = 277.3;
  model.create_time_ns = 5;
  ASSERT_THAT(store_->CreateModel(model), IsOk());
  EXPECT_THAT(store_->CreateModel(model),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr(model.name)));
  StoredModel other;
  other.name = "deviationModels/narrow";
  ASSERT_THAT(store_->CreateModel(other), IsOk());

  const auto got = store_->GetModel(model.name);
  ASSERT_THAT(got, IsOk());
  EXPECT_TRUE(got->model == model.model);
  EXPECT_EQ(got->training.seed, model.training.seed);
  EXPECT_EQ(got->training.focal_px, 277.3);
  EXPECT_EQ(got->create_time_ns, 5);
  EXPECT_THAT(store_->GetModel("deviationModels/none"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none")));
  const auto all = store_->ListModels("", 10);
  ASSERT_THAT(all, IsOk());
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ((*all)[0].name, other.name);
  EXPECT_EQ(store_->ListModels(other.name, 10)->at(0).name, model.name);
}

INSTANTIATE_TEST_SUITE_P(Stores, JourneyStoreTest, EveryKind(), KindName);

TEST(OpenJourneyStore, RefusesAnAddressItDoesNotKnow) {
  for (const char* url : {"", "sqlite:", "homing.db", "mysql://x"}) {
    StoreOptions options;
    options.url = url;
    EXPECT_THAT(OpenJourneyStore(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("sqlite:PATH")));
  }
}

TEST(OpenJourneyStore, RefusesAFolderThatDoesNotExist) {
  StoreOptions options;
  options.url = "sqlite:/nonexistent/homing.db";
  EXPECT_THAT(OpenJourneyStore(options),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("unable to open")));
}

TEST(OpenJourneyStore, IsForOneServerAtATime) {
  const TemporaryFolder folder;
  auto first = OpenOrDie(folder.Database());
  StoreOptions options;
  options.url = folder.Database();
  EXPECT_THAT(OpenJourneyStore(options),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("another homing-server")));
  first.reset();
  EXPECT_THAT(OpenJourneyStore(options), IsOk());
}

TEST(OpenJourneyStore, IsForOneServerAlsoByALinkOrWithoutTheLockFile) {
  const TemporaryFolder folder;
  const auto first = OpenOrDie(folder.Database());
  const auto in_use = StatusIs(absl::StatusCode::kUnavailable, HasSubstr("another homing-server"));
  std::filesystem::create_hard_link(folder.File("homing.db"), folder.File("link.db"));
  std::filesystem::create_symlink(folder.File("homing.db"), folder.File("symlink.db"));
  std::filesystem::remove(folder.File("homing.db-lock"));
  for (const char* name : {"link.db", "symlink.db", "homing.db"}) {
    for (const bool read_only : {false, true}) {
      StoreOptions options;
      options.url = "sqlite:" + folder.File(name);
      options.read_only = read_only;
      EXPECT_THAT(OpenJourneyStore(options), in_use) << name;
    }
  }
  EXPECT_THAT(first->CreateJourney(Record(kJourney)), IsOk());
}

}  // namespace
}  // namespace homing::storage
