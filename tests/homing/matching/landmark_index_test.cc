#include "homing/matching/landmark_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "absl/strings/str_cat.h"

namespace homing {
namespace {

struct StoredFingerprint {
  int journey = 0;
  std::int64_t step = 0;
  Side side = Side::kLeft;
  Fingerprint fingerprint;
};

// An index, and beside it all that was ever put into it.
struct Fleet {
  LandmarkIndex index;
  std::vector<DeviationModel> models;
  std::vector<StoredFingerprint> all;
  std::set<int> removed;

  int Add(const std::string& name, const DeviationModel& model = {}) {
    const int journey = index.AddJourney(name, model);
    const auto number = static_cast<std::size_t>(journey);
    models.resize(std::max(models.size(), number + 1));
    models[number] = model;
    // The number of a removed journey may be given out again.
    if (removed.erase(journey) > 0) {
      std::erase_if(all, [journey](const auto& stored) { return stored.journey == journey; });
    }
    return journey;
  }
  void Put(int journey, std::int64_t step, Side side, const Fingerprint& f) {
    JourneyStep recorded;
    recorded.step = step;
    recorded.fingerprints.push_back({side, f, 0});
    index.Append(journey, recorded);
    all.push_back({journey, step, side, f});
  }
};

// The plain scan: every fingerprint, every landmark seen, erfc and all; then sorted.
std::vector<Match> Scan(const Fleet& fleet, const SeenSides& seen, const MatchOptions& options,
                        const LandmarkIndex::Covers& covers, bool distinct) {
  std::vector<Match> matches;
  for (const StoredFingerprint& stored : fleet.all) {
    if (fleet.removed.count(stored.journey) > 0 || (covers && !covers(stored.journey))) continue;
    for (const SeenLandmark& landmark : seen[static_cast<std::size_t>(stored.side)]) {
      const Fingerprint query{landmark.x, landmark.y, landmark.count, 0};
      const Similarity similarity = Compare(query, stored.fingerprint,
                                            fleet.models[static_cast<std::size_t>(stored.journey)]);
      if (similarity.p_t > 0 && similarity.p_t >= options.threshold) {
        matches.push_back(
            {stored.journey, stored.fingerprint.landmark, stored.step, stored.side, similarity});
      }
    }
  }
  std::stable_sort(matches.begin(), matches.end(), [&](const Match& a, const Match& b) {
    if (a.similarity.p_t != b.similarity.p_t) return a.similarity.p_t > b.similarity.p_t;
    if (a.journey != b.journey) return fleet.index.name(a.journey) < fleet.index.name(b.journey);
    return std::tie(a.step, a.side, a.landmark) < std::tie(b.step, b.side, b.landmark);
  });
  std::vector<Match> kept;
  std::set<std::pair<int, std::int32_t>> known;
  for (const Match& match : matches) {
    if (distinct && !known.insert({match.journey, match.landmark}).second) continue;
    kept.push_back(match);
  }
  kept.resize(std::min(kept.size(), static_cast<std::size_t>(options.max_matches)));
  return kept;
}

void ExpectSame(const std::vector<Match>& found, const std::vector<Match>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(found[i].journey, expected[i].journey);
    EXPECT_EQ(found[i].landmark, expected[i].landmark);
    EXPECT_EQ(found[i].step, expected[i].step);
    EXPECT_EQ(found[i].side, expected[i].side);
    EXPECT_EQ(found[i].similarity.delta, expected[i].similarity.delta);
    EXPECT_EQ(found[i].similarity.p, expected[i].similarity.p);
    EXPECT_EQ(found[i].similarity.p_t, expected[i].similarity.p_t);
  }
}

void ExpectFindsWhatAScanFinds(const Fleet& fleet, const SeenSides& seen,
                               const MatchOptions& options,
                               const LandmarkIndex::Covers& covers = nullptr) {
  ExpectSame(fleet.index.FindLandmarks(seen, options, covers),
             Scan(fleet, seen, options, covers, true));
  ExpectSame(fleet.index.FindFingerprints(seen, options, covers),
             Scan(fleet, seen, options, covers, false));
}

// How means and numbers lie.
enum class Layout { kUniform, kCoarse, kOnePlace, kClusters, kFar };

class LandmarkIndexProperty : public testing::TestWithParam<std::tuple<Layout, int>> {
 protected:
  int Uniform(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  float Real(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }

  SeenLandmark Draw() {
    SeenLandmark drawn;
    switch (std::get<0>(GetParam())) {
      case Layout::kUniform:
        drawn.x = Real(0, 640);
        drawn.y = Real(0, 480);
        drawn.count = Uniform(1, 300);
        break;
      case Layout::kCoarse:  // Full of ties.
        drawn.x = static_cast<float>(Uniform(0, 3)) * 8;
        drawn.y = static_cast<float>(Uniform(0, 2)) * 8;
        drawn.count = Uniform(1, 4);
        break;
      case Layout::kOnePlace:
        drawn.x = 100;
        drawn.y = Uniform(0, 99) == 0 ? 101.0F : 100.0F;
        drawn.count = 20;
        break;
      case Layout::kClusters:
        drawn.x = static_cast<float>(Uniform(0, 4)) * 100 + Real(-3, 3);
        drawn.y = Real(239, 241);
        drawn.count = static_cast<int>(std::exp(Real(0, 9)));
        break;
      case Layout::kFar:  // Where float runs out of digits.
        drawn.x = Real(-1, 1) * 1e30F;
        drawn.y = Real(-1e-30F, 1e-30F);
        drawn.count = Uniform(0x7ffffff0, 0x7fffffff);
        break;
    }
    return drawn;
  }

  void Fill(Fleet& fleet, int fingerprints) {
    for (int i = 0; i < fingerprints; ++i) {
      const int journey = Uniform(0, static_cast<int>(fleet.models.size()) - 1);
      if (fleet.removed.count(journey) > 0) continue;
      const SeenLandmark drawn = Draw();
      // Sides by landmark, so that a landmark has one.
      const int landmark = Uniform(0, 9);
      fleet.Put(journey, next_step_++, Side{landmark % 2},
                {drawn.x, drawn.y, drawn.count, landmark});
    }
  }

  SeenSides DrawSeen() {
    SeenSides seen;
    for (std::vector<SeenLandmark>& side : seen) {
      for (int i = Uniform(0, 2); i > 0; --i) side.push_back(Draw());
    }
    return seen;
  }

  std::mt19937 random_{static_cast<std::uint32_t>(std::get<1>(GetParam()))};
  std::int64_t next_step_ = 0;
};

TEST_P(LandmarkIndexProperty, FindsWhatAScanFindsAfterLoadingAppendingAndRemoving) {
  Fleet fleet;
  // Names not in the order of numbers; three deviation models, one of them very narrow.
  for (int i = 0; i < 12; ++i) {
    DeviationModel model;
    if (i % 3 == 1) model = {.mu = 1.0, .sigma = 0.5};
    if (i % 3 == 2) model = {.mu = -3.0, .sigma = 0.1};
    fleet.Add(absl::StrCat("robots/", 50 - i, "/journeys/", i % 2), model);
  }
  fleet.index.BeginLoading();
  Fill(fleet, Uniform(0, 1000));
  fleet.index.EndLoading();
  for (int round = 0; round < 12; ++round) {
    Fill(fleet, Uniform(1, 300));
    if (round % 3 == 2) {
      const int gone = Uniform(0, 11);
      if (fleet.removed.insert(gone).second) fleet.index.Remove(gone);
      // Removed and not yet swept, half swept, all swept: searches never see it.
      for (int i = Uniform(0, 40); i > 0 && fleet.index.Sweep(3); --i) {
      }
      fleet.Add(absl::StrCat("robots/r/journeys/", round), {.mu = -3.0, .sigma = 0.1});
    }
    const int covered = Uniform(0, 12);
    const auto covers = [covered](int journey) { return journey < covered; };
    for (const int most : {1, 10, 1000}) {
      for (const double threshold : {0.0, 0.2, 0.97}) {
        const SeenSides seen = DrawSeen();
        ExpectFindsWhatAScanFinds(fleet, seen, {most, threshold});
        ExpectFindsWhatAScanFinds(fleet, seen, {most, threshold}, covers);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, LandmarkIndexProperty,
                         testing::Combine(testing::Values(Layout::kUniform, Layout::kCoarse,
                                                          Layout::kOnePlace, Layout::kClusters,
                                                          Layout::kFar),
                                          testing::Range(1, 6)));

TEST(LandmarkIndexTest, AnEmptyIndexFindsNothing) {
  const LandmarkIndex index;
  SeenSides seen;
  seen[0].push_back({.x = 1, .y = 2, .count = 3});
  EXPECT_TRUE(index.FindLandmarks(seen, {}, nullptr).empty());
}

TEST(LandmarkIndexTest, ALandmarkSeenWithNoVectorsMatchesNothing) {
  Fleet fleet;
  fleet.Put(fleet.Add("robots/r/journeys/j"), 0, Side::kLeft, {10, 10, 5, 0});
  SeenSides seen;
  seen[0].push_back({.x = 10, .y = 10, .count = 0});
  EXPECT_TRUE(fleet.index.FindLandmarks(seen, {10, 0.0}, nullptr).empty());
}

TEST(LandmarkIndexTest, AgreesWithTheScanOfMaps) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0, 200);
  std::uniform_int_distribution<int> count(1, 60);
  std::vector<JourneyMap> maps(5);
  std::vector<std::string> names;
  LandmarkIndex index;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    names.push_back(absl::StrCat("robots/r/journeys/", i));
    for (int step = 0; step < 400; ++step) {
      JourneyStep recorded;
      recorded.step = step;
      // A landmark a side and ten steps.
      for (const Side side : {Side::kLeft, Side::kRight}) {
        const int landmark = 2 * (step / 10) + static_cast<int>(side);
        recorded.fingerprints.push_back(
            {side, {place(random), place(random), count(random), landmark}, 0});
      }
      ASSERT_TRUE(maps[i].Append(recorded).ok());
    }
    index.Append(index.AddJourney(names.back(), {}), maps[i]);
  }
  std::vector<JourneyRef> refs;
  for (std::size_t i = 0; i < maps.size(); ++i) refs.push_back({&names[i], &maps[i]});
  for (int query = 0; query < 50; ++query) {
    SeenSides seen;
    for (std::vector<SeenLandmark>& side : seen) {
      side.push_back({.x = place(random), .y = place(random), .count = count(random)});
      side.push_back({.x = place(random), .y = place(random), .count = count(random)});
    }
    ExpectSame(index.FindLandmarks(seen, {10, 0.2}, nullptr),
               Matcher().Find(refs, seen, {10, 0.2}));
  }
}

TEST(LandmarkIndexTest, VisitsFewOfManyFingerprints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0, 480);
  std::uniform_int_distribution<int> count(1, 200);
  LandmarkIndex index;
  const int journey = index.AddJourney("robots/r/journeys/j", {});
  for (int step = 0; step < 100'000; ++step) {
    JourneyStep recorded;
    recorded.step = step;
    recorded.fingerprints.push_back(
        {Side::kLeft, {place(random), place(random), count(random), step / 10}, 0});
    index.Append(journey, recorded);
  }
  SearchCost cost;
  SeenSides seen;
  seen[0].push_back({.x = 240, .y = 240, .count = 100});
  EXPECT_EQ(index.FindLandmarks(seen, {}, nullptr, &cost).size(), 10U);
  EXPECT_GT(cost.visited, 0);
  EXPECT_LT(cost.visited, 5'000);
  EXPECT_LE(index.MemoryBytes(), 100'000U * 32);
}

}  // namespace
}  // namespace homing
