#include "server/session/localization_session.h"

#include <atomic>
#include <thread>

#include "server/base/worker_pool.h"
#include "server/catalog/journey_selection.h"
#include "server/catalog/model_catalog.h"
#include "server/session/landmark_query.h"
#include "storage/connection.h"
#include "tests/server/session/session_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class LocalizationSessionTest : public SessionTest {
 protected:
  void SetUp() override { Create(); }

  absl::StatusOr<std::unique_ptr<LocalizationSession>> Open(const std::string& journey = kJourney) {
    LocalizationQuery query;
    query.journey = journey;
    query.travel = Travel::kSame;
    return LocalizationSession::Open(catalog_.get(), query, {});
  }

  // A journey whose settings are changed by `change`, with one flow of the given width.
  void CreateOther(const std::string& name, int width, double min_vector_length_px) {
    storage::JourneyRecord record;
    record.name = name;
    record.writer_id = "writer";
    record.settings.landmark.min_vector_length_px = min_vector_length_px;
    ASSERT_THAT(catalog_->Create(record), IsOk());
    Ear ear;
    const auto session = RecordingSession::Open({catalog_.get(), queue_.get(), {}}, name, "writer",
                                                {}, ear.Listener());
    ASSERT_THAT(session, IsOk());
    Observation observation = test::FlowAt(0);
    observation.views = {test::FieldAt(0, Side::kLeft, width), std::monostate()};
    (*session)->Record(observation, {});
    ear.AwaitAnswers(2);
  }

  // Names of the journeys that a query of the route's own camera searches.
  std::vector<std::string> Selected(const std::string& pattern_name) {
    const JourneyName pattern = ParseJourneyPattern(pattern_name, "journey").value();
    QueryRobot robot;
    robot.travel = Travel::kSame;
    robot.widths = {test::kWidth, test::kWidth};
    robot.heights = {test::kHeight, test::kHeight};
    std::vector<std::string> names;
    const auto selection = SelectJourneys(catalog_->Resolve(pattern).value(), pattern, robot);
    EXPECT_THAT(selection, IsOk());
    for (const auto& journey : selection->journeys) {
      names.push_back(journey->name());
    }
    return names;
  }
};

TEST_F(LocalizationSessionTest, StepsThatAreRecordedMeanwhileAreFound) {
  RecordFlow(0, 10);
  const auto session = Open().value();
  auto answer = session->Localize(test::FlowAt(0, 5));
  ASSERT_THAT(answer, IsOk());
  ASSERT_FALSE(answer->matches.empty());
  EXPECT_EQ(answer->matches[0].step, 5);
  EXPECT_EQ(session->journey_name(answer->matches[0].journey), kJourney);
  RecordFlow(10, 40);
  answer = session->Localize(test::FlowAt(1, 35));
  ASSERT_THAT(answer, IsOk());
  ASSERT_FALSE(answer->matches.empty());
  EXPECT_EQ(answer->matches[0].step, 35);
  EXPECT_DOUBLE_EQ(answer->matches[0].similarity.p_t, 1);
}

TEST_F(LocalizationSessionTest, NumbersMayBeginAnywhereAndThenHaveNoGap) {
  RecordFlow(0, 10);
  const auto session = Open().value();
  ASSERT_THAT(session->Localize(test::FlowAt(7, 5)), IsOk());
  EXPECT_THAT(session->Localize(test::FlowAt(9, 6)),
              StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("must be 8")));
  EXPECT_THAT(session->Localize(test::FlowAt(7, 5)),
              StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("must be 8")));
  EXPECT_THAT(session->Localize(test::FlowAt(8, 6)), IsOk());
}

TEST_F(LocalizationSessionTest, ADeletedJourneyIsNotFoundWhenItWasNamed) {
  RecordFlow(0, 10);
  const auto named = Open().value();
  const auto covered = Open("robots/-/journeys/-").value();
  ASSERT_THAT(named->Localize(test::FlowAt(0)), IsOk());
  ASSERT_THAT(covered->Localize(test::FlowAt(0)), IsOk());
  ASSERT_THAT(catalog_->Delete(kJourney), IsOk());
  EXPECT_THAT(named->Localize(test::FlowAt(1)),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("deleted")));
  EXPECT_THAT(covered->Localize(test::FlowAt(1)),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("deleted")));
}

TEST_F(LocalizationSessionTest, ABadQueryIsRefusedAtOnce) {
  EXPECT_THAT(Open("robots/r/journeys/none"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none")));
  EXPECT_THAT(Open("journeys/out"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("config.journey")));
  LocalizationQuery query;
  query.journey = kJourney;
  query.match.threshold = 2;
  EXPECT_THAT(LocalizationSession::Open(catalog_.get(), query, {}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("threshold")));
}

TEST_F(LocalizationSessionTest, AWildcardTakesTheMostFrequentSettingsOfTheSameImageSize) {
  RecordFlow(0, 2);
  CreateOther("robots/r/journeys/wide", 640, 1);
  EXPECT_EQ(Selected("robots/-/journeys/-"), std::vector<std::string>{kJourney});
  const std::vector<std::string> others = {"robots/s/journeys/a", "robots/s/journeys/b"};
  for (const std::string& name : others) {
    CreateOther(name, test::kWidth, 1);
  }
  EXPECT_EQ(Selected("robots/-/journeys/-"), others);
  EXPECT_EQ(Selected(kJourney), std::vector<std::string>{kJourney});
}

TEST_F(LocalizationSessionTest, FingerprintsAreMatchedAsTheyAre) {
  RecordFlow(0, 10);
  const auto live = catalog_->Open(kJourney).value();
  Fingerprint stored;
  {
    const LiveJourneys one = {live};
    const MapsLock lock(one);
    stored = live->map().fingerprints(4)[0];
  }
  LandmarkQuery query;
  query.journey = kJourney;
  query.travel = Travel::kSame;
  SeenLandmark seen;
  seen.x = stored.x;
  seen.y = stored.y;
  seen.count = stored.count;
  query.views[0] = SeenFingerprints{0, 0, {seen}};
  const auto result = LoadAndMatch(catalog_.get(), query);
  ASSERT_THAT(result, IsOk());
  EXPECT_FALSE(result->motion);
  ASSERT_FALSE(result->matches.empty());
  EXPECT_EQ(result->matches[0].match.step, 4);
  EXPECT_DOUBLE_EQ(result->matches[0].match.similarity.p_t, 1);
  seen.x = std::nanf("");
  query.views[0] = SeenFingerprints{0, 0, {seen}};
  EXPECT_THAT(LoadAndMatch(catalog_.get(), query),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("nan")));
}

// For ThreadSanitizer: writers, readers, lists, finishes and takeovers at the same time.
TEST_F(LocalizationSessionTest, RecordingAndLocalisingAtOnceLosesNothing) {
  constexpr int kWriters = 3;
  constexpr int kPlaces = 60;
  RecordFlow(0, 5);
  std::atomic<int> writing = kWriters;
  std::vector<std::thread> threads;
  for (int w = 0; w < kWriters; ++w) {
    const std::string name = "robots/w/journeys/j" + std::to_string(w);
    Create(name);
    threads.emplace_back([this, name, &writing] {
      for (int first = 0; first < kPlaces; first += 20) {
        RecordFlow(first, first + 20, name);
      }
      --writing;
    });
  }
  for (const char* pattern : {"robots/-/journeys/-", kJourney}) {
    threads.emplace_back([this, pattern, &writing] {
      do {
        const auto session = Open(pattern).value();
        for (int i = 0; i < 5; ++i) {
          EXPECT_THAT(session->Localize(test::FlowAt(i)), IsOk());
        }
        EXPECT_THAT(catalog_->List(kWildcard, "", 100), IsOk());
      } while (writing > 0);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (int w = 0; w < kWriters; ++w) {
    const std::string name = "robots/w/journeys/j" + std::to_string(w);
    const LiveJourneys one = {catalog_->Open(name).value()};
    const MapsLock lock(one);
    EXPECT_EQ(one[0]->map().step_count(), kPlaces);
    ExpectSameMap(one[0]->map(), store_->LoadMap(name).value());
  }
}

TEST_F(LocalizationSessionTest, EndsOnceTheCallerMayNotUseTheJourneyAnyMore) {
  RecordFlow(0, 5);
  Create("robots/r/journeys/own");
  RecordFlow(0, 5, "robots/r/journeys/own");
  bool is_reader = true;
  for (const char* pattern : {kJourney, "robots/r/journeys/-"}) {
    is_reader = true;
    LocalizationQuery query;
    query.journey = pattern;
    query.travel = Travel::kSame;
    query.filter = [&](const storage::JourneyRecord& record) {
      return is_reader || record.name != kJourney;
    };
    const auto session = LocalizationSession::Open(catalog_.get(), query, {});
    ASSERT_THAT(session, IsOk());
    EXPECT_THAT((*session)->Localize(test::FlowAt(0)), IsOk());
    is_reader = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    const auto later = (*session)->Localize(test::FlowAt(1));
    if (pattern == std::string(kJourney)) {
      EXPECT_THAT(later,
                  StatusIs(absl::StatusCode::kPermissionDenied, HasSubstr("readers were changed")));
    } else {
      // The other one is left.
      ASSERT_THAT(later, IsOk());
      EXPECT_EQ((*session)->journey_name(0), "robots/r/journeys/own");
    }
  }
}

TEST_F(LocalizationSessionTest, AWildcardSkipsADamagedJourney) {
  RecordFlow(0, 5);
  Create("robots/r/journeys/whole");
  RecordFlow(0, 5, "robots/r/journeys/whole");
  queue_.reset();
  catalog_.reset();
  store_.reset();
  {
    auto connection = storage::Connection::Open(folder_.File("homing.db"),
                                                storage::Connection::Access::kReadWrite, 1000);
    ASSERT_THAT((*connection)->Run([&] {
      (*connection)->Execute("DELETE FROM steps WHERE journey_id = 1 AND step = 2");
      return absl::OkStatus();
    }),
                IsOk());
  }
  OpenStore(0);
  const auto session = Open("robots/r/journeys/-");
  ASSERT_THAT(session, IsOk());
  EXPECT_THAT((*session)->Localize(test::FlowAt(0)), IsOk());
  EXPECT_EQ((*session)->journey_name(0), "robots/r/journeys/whole");
  EXPECT_EQ(catalog_->damaged(), 1);
  EXPECT_THAT(Open(kJourney), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("damaged")));
  ASSERT_THAT(catalog_->Delete(kJourney), IsOk());
  EXPECT_EQ(catalog_->damaged(), 0);
}

class ModelCatalogTest : public SessionTest {};

TEST_F(ModelCatalogTest, TheBuiltInModelStandsInItsPlaceInTheList) {
  ModelCatalog models(store_.get());
  TrainingOptions options;
  for (const char* id : {"zebra", "ant"}) {
    ++options.seed;
    ASSERT_THAT(models.Train(id, options, 5), IsOk());
  }
  std::vector<std::string> names;
  std::string after;
  while (true) {
    const auto page = models.List(after, 1).value();
    if (page.empty()) {
      break;
    }
    after = page[0].name;
    names.push_back(after);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"deviationModels/ant", "deviationModels/default",
                                             "deviationModels/zebra"}));
}

TEST_F(ModelCatalogTest, TrainingAgainGivesTheStoredModelUnlessSettingsDiffer) {
  ModelCatalog models(store_.get());
  TrainingOptions options;
  const auto first = models.Train("m", options, 5);
  ASSERT_THAT(first, IsOk());
  const auto again = models.Train("m", options, 9);
  ASSERT_THAT(again, IsOk());
  EXPECT_EQ(again->stored.create_time_ns, 5);
  options.seed = 77;
  EXPECT_THAT(models.Train("m", options, 9),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("\"m\"")));
  EXPECT_THAT(models.Train("default", options, 9),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("built in")));
}

}  // namespace
}  // namespace homing::server
