// Versions of the file: every released schema opens, a newer one is refused.
#include "storage/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <tuple>

#include "absl/strings/escaping.h"
#include "homing/landmark/profile_code.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

// Runs `sql` on a file, which may not exist yet.
void Execute(const std::string& path, const std::string& sql) {
  auto connection = Connection::Open(path, Connection::Access::kReadWrite, 100);
  ASSERT_THAT(connection, IsOk());
  ASSERT_THAT((*connection)->Run([&] {
    (*connection)->Execute(sql);
    return absl::OkStatus();
  }),
              IsOk());
}

// The result of `sql`, as one value.
std::string Ask(const std::string& path, const std::string& sql) {
  auto connection = Connection::Open(path, Connection::Access::kReadOnly, 100);
  EXPECT_THAT(connection, IsOk());
  std::string value;
  EXPECT_THAT((*connection)->Run([&] {
    value = (*connection)->Text(sql);
    return absl::OkStatus();
  }),
              IsOk());
  return value;
}

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// One file a released version: tests/storage/schema/vN.sql, tables and a journey of 12 steps.
class OldSchema : public ::testing::TestWithParam<int> {};

TEST_P(OldSchema, OpensWithAllItsJourneysAndTakesMore) {
  const TemporaryFolder folder;
  Execute(folder.File("homing.db"),
          ReadText(HOMING_SCHEMA_DIR "/v" + std::to_string(GetParam()) + ".sql"));
  auto store = OpenOrDie(folder.Database());
  const std::vector<JourneyStep> steps = MakeSteps(20);
  const auto map = store->LoadMap("robots/old/journeys/1");
  ASSERT_THAT(map, IsOk());
  EXPECT_TRUE(SameMap(*map, MapOf(OddSettings(), {steps.begin(), steps.begin() + 12})));
  EXPECT_EQ(store->GetJourney("robots/old/journeys/1")->writer_id, "writer");
  ASSERT_THAT(store->GetModel("deviationModels/old"), IsOk());
  AppendAll(*store, "robots/old/journeys/1", {steps.begin() + 12, steps.end()});
  EXPECT_TRUE(SameMap(*store->LoadMap("robots/old/journeys/1"), MapOf(OddSettings(), steps)));
  EXPECT_EQ(Ask(folder.File("homing.db"), "PRAGMA user_version"), std::to_string(kSchemaVersion));
}

INSTANTIATE_TEST_SUITE_P(Versions, OldSchema,
                         ::testing::Range(1, static_cast<int>(kSchemaVersion) + 1));

// Of steps with and without fingerprints.
TEST(Schema, FlowProfilesOfAnOlderVersionStay) {
  const TemporaryFolder folder;
  const std::string path = folder.File("homing.db");
  std::vector<JourneyStep> steps = MakeSteps(12);
  steps.emplace_back().step = 12;
  steps = WithProfiles(steps);
  Execute(path, ReadText(HOMING_SCHEMA_DIR "/v2.sql"));
  for (const JourneyStep& step : steps) {
    for (int side = 0; side < 2; ++side) {
      const auto& profile = step.profiles[static_cast<std::size_t>(side)];
      if (!profile) continue;
      const std::string id = std::to_string((1 << 27) + step.step * 4 + side);
      Execute(path, "INSERT INTO profiles VALUES (" + id + ", x'" +
                        absl::BytesToHexString(EncodeProfile(*profile)) + "')");
    }
  }
  Execute(path, "UPDATE journeys SET step_count = 13, next_sequence = 13");
  const auto map = OpenOrDie(folder.Database())->LoadMap("robots/old/journeys/1");
  ASSERT_THAT(map, IsOk());
  EXPECT_TRUE(SameMap(*map, MapOf(OddSettings(), steps)));
}

// Each frame but the first made a step, and each field of flow vectors.
TEST(Schema, StepsOfAnOlderVersionKeepTheFrameThatMadeThem) {
  for (const auto& [input, first, resend_from] :
       {std::tuple("FRAMES", 1, 11), std::tuple("FLOW_VECTORS", 0, 12),
        std::tuple("UNKNOWN", 1, 11)}) {
    const TemporaryFolder folder;
    const std::string path = folder.File("homing.db");
    Execute(path, ReadText(HOMING_SCHEMA_DIR "/v3.sql"));
    Execute(path, std::string("UPDATE journeys SET next_sequence = 12, input = '") + input + "'");
    // A step without a row, as those that saw nothing had none; and the last one.
    Execute(path, "DELETE FROM steps WHERE step IN (3, 11)");
    auto store = OpenOrDie(folder.Database());
    const auto tail = store->LoadTail("robots/old/journeys/1");
    ASSERT_THAT(tail, IsOk());
    EXPECT_EQ(tail->last_sequence, first + 11);
    EXPECT_EQ(store->GetJourney("robots/old/journeys/1")->resend_from, resend_from);
    EXPECT_EQ(Ask(path, "SELECT min(sequence - step) || ' ' || max(sequence - step) FROM steps"),
              std::to_string(first) + " " + std::to_string(first));
  }
}

TEST(Schema, ANewFileHasTheVersionAndTheMarkOfThisProgram) {
  const TemporaryFolder folder;
  OpenOrDie(folder.Database());
  const std::string path = folder.File("homing.db");
  EXPECT_EQ(Ask(path, "PRAGMA user_version"), "4");
  EXPECT_EQ(Ask(path, "PRAGMA application_id"), std::to_string(0x484F4D49));
  EXPECT_EQ(Ask(path, "PRAGMA journal_mode"), "wal");
}

TEST(Schema, ANewerVersionIsRefusedAndLeftAsItIs) {
  const TemporaryFolder folder;
  const std::string path = folder.File("homing.db");
  OpenOrDie(folder.Database());
  Execute(path, "PRAGMA user_version=5");
  StoreOptions options;
  options.url = folder.Database();
  EXPECT_THAT(OpenJourneyStore(options), StatusIs(absl::StatusCode::kFailedPrecondition,
                                                  HasSubstr("version is 5, newer than")));
  EXPECT_EQ(Ask(path, "PRAGMA user_version"), "5");
}

TEST(Schema, AnotherProgramsFileIsRefusedAndLeftAsItIs) {
  const TemporaryFolder folder;
  const std::string path = folder.File("homing.db");
  Execute(path, "CREATE TABLE songs (title TEXT)");
  StoreOptions options;
  options.url = folder.Database();
  EXPECT_THAT(OpenJourneyStore(options),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("another program")));
  EXPECT_EQ(Ask(path, "SELECT count(*) FROM sqlite_schema"), "1");
}

TEST(Schema, PlainSqlReadsTheJourneysByName) {
  const TemporaryFolder folder;
  const std::string path = folder.File("homing.db");
  auto store = OpenOrDie(folder.Database());
  const std::vector<JourneyStep> steps = MakeSteps(12);
  for (const char* name : {"a", "b"}) {
    ASSERT_THAT(store->CreateJourney(Record(name)), IsOk());
    AppendAll(*store, name, steps);
  }
  EXPECT_EQ(Ask(path, "SELECT count(*) FROM journey_fingerprints WHERE journey='b' AND step=11"),
            "4");
  EXPECT_EQ(Ask(path, "SELECT count(*) FROM steps WHERE journey_id=2 AND step=11"), "1");
  EXPECT_EQ(Ask(path, "SELECT count(*) FROM journey_landmarks WHERE journey='a'"),
            std::to_string(store->GetJourney("a")->landmark_count));
  EXPECT_EQ(Ask(path,
                "SELECT max(first_step) || ' ' || max(last_step) || ' ' || sum(fingerprint_count)"
                " FROM journey_landmarks WHERE journey='a'"),
            Ask(path,
                "SELECT (SELECT first_step FROM journey_landmarks WHERE journey='b'"
                " ORDER BY landmark DESC) || ' 11 ' || fingerprint_count FROM journeys"
                " WHERE name='b'"));
  EXPECT_EQ(Ask(path,
                "SELECT settings ->> '$.flow.cell_px' FROM journeys"
                " JOIN journey_settings USING (journey_id) WHERE name='a'"),
            "9");
}

}  // namespace
}  // namespace homing::storage
