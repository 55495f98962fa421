#include "homing/matching/matcher.h"

#include <algorithm>
#include <map>
#include <random>

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// A journey of fingerprints at random; landmarks last a few steps.
JourneyMap RandomMap(std::mt19937_64& engine, double mu, std::int64_t steps = 60) {
  JourneySettings settings;
  settings.deviation_model.mu = mu;
  JourneyMap map(settings);
  for (std::int64_t number = 0; number < steps; ++number) {
    JourneyStep step{.step = number, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    auto next = static_cast<std::int32_t>(map.landmarks().size());
    for (const Side side : {Side::kLeft, Side::kRight}) {
      for (std::uint64_t i = engine() % 3; i > 0; --i) {
        std::int32_t landmark = next;
        const auto last = static_cast<std::int32_t>(map.landmarks().size()) - 1;
        const bool goes_on = last >= 0 && engine() % 2 == 0 &&
                             map.landmarks()[static_cast<std::size_t>(last)].side == side;
        if (goes_on &&
            (step.fingerprints.empty() || step.fingerprints.back().fingerprint.landmark != last)) {
          landmark = last;
        } else {
          ++next;
        }
        step.fingerprints.push_back(
            {side,
             {static_cast<float>(engine() % 40), static_cast<float>(engine() % 30),
              static_cast<std::int32_t>(1 + engine() % 50), landmark},
             0});
      }
    }
    EXPECT_THAT(map.Append(step), IsOk());
  }
  return map;
}

SeenSides RandomSeen(std::mt19937_64& engine, std::size_t most = 2) {
  SeenSides seen;
  for (auto& side : seen) {
    side.resize(engine() % (most + 1));
    for (SeenLandmark& landmark : side) {
      landmark.x = static_cast<float>(engine() % 40);
      landmark.y = static_cast<float>(engine() % 30);
      landmark.count = static_cast<int>(1 + engine() % 50);
    }
  }
  return seen;
}

// Everything with everything, then sorted.
std::vector<Match> NaiveMatches(std::span<const JourneyRef> journeys, const SeenSides& seen,
                                const MatchOptions& options) {
  std::map<std::pair<int, std::int32_t>, Match> best;
  for (int j = 0; j < static_cast<int>(journeys.size()); ++j) {
    const JourneyMap& map = *journeys[static_cast<std::size_t>(j)].map;
    for (std::int64_t step = 0; step < map.step_count(); ++step) {
      for (const Fingerprint& stored : map.fingerprints(step)) {
        for (const SeenLandmark& s : seen[static_cast<std::size_t>(map.side_of(stored))]) {
          const Similarity similarity = Compare(
              MeanAndCount{double{s.x}, double{s.y}, static_cast<double>(s.count)},
              MeanAndCount{double{stored.x}, double{stored.y}, static_cast<double>(stored.count)},
              map.settings().deviation_model);
          Match& match = best[{j, stored.landmark}];
          if (similarity.p_t >= options.threshold && similarity.p_t > match.similarity.p_t) {
            match = {j, stored.landmark, step, map.side_of(stored), similarity};
          }
        }
      }
    }
  }
  std::vector<Match> matches;
  for (const auto& [key, match] : best) {
    if (match.similarity.p_t > 0) {
      matches.push_back(match);
    }
  }
  std::sort(matches.begin(), matches.end(), [&](const Match& a, const Match& b) {
    const auto key = [&](const Match& m) {
      return std::tuple(-m.similarity.p_t, *journeys[static_cast<std::size_t>(m.journey)].name,
                        m.step, m.side, m.landmark);
    };
    return key(a) < key(b);
  });
  matches.resize(std::min(matches.size(), static_cast<std::size_t>(options.max_matches)));
  return matches;
}

void ExpectSame(const std::vector<Match>& actual, const std::vector<Match>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].journey, expected[i].journey);
    EXPECT_EQ(actual[i].landmark, expected[i].landmark);
    EXPECT_EQ(actual[i].step, expected[i].step);
    EXPECT_EQ(actual[i].side, expected[i].side);
    EXPECT_EQ(actual[i].similarity.p_t, expected[i].similarity.p_t);
  }
}

TEST(MatcherTest, AgreesWithAScanOfEverything) {
  const std::string first_name = "robots/b/journeys/1";
  const std::string second_name = "robots/a/journeys/1";
  std::size_t found = 0;
  Matcher matcher;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 engine(seed);
    const JourneyMap first = RandomMap(engine, 2.24);
    const JourneyMap second = seed % 3 == 0 ? first : RandomMap(engine, 1.5);
    const std::vector<JourneyRef> journeys{{&first_name, &first}, {&second_name, &second}};
    const SeenSides seen = RandomSeen(engine);
    for (const double threshold : {0.0, 0.2, 0.6}) {
      for (const int most : {1, 10, 1000}) {
        const MatchOptions options{.max_matches = most, .threshold = threshold};
        const auto matches = matcher.Find(journeys, seen, options);
        ExpectSame(matches, NaiveMatches(journeys, seen, options));
        found += matches.size();
      }
    }
  }
  EXPECT_GT(found, 1000u);
}

TEST(MatcherTest, TheLikelySimilarityDoesNotChangeTheResult) {
  const std::string name = "robots/a/journeys/1";
  Matcher matcher;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    const JourneyMap map = RandomMap(engine, 2.24);
    const JourneyRef journey{&name, &map};
    const SeenSides seen = RandomSeen(engine);
    for (const MatchOptions options : {MatchOptions{5, 0}, MatchOptions{10, 0.2}}) {
      const auto expected = NaiveMatches({&journey, 1}, seen, options);
      for (const double likely : {0.0, 0.1, 0.6, 0.9, 1.0}) {
        SCOPED_TRACE(likely);
        ExpectSame(matcher.Find({&journey, 1}, seen, options, nullptr, likely), expected);
      }
    }
  }
}

// More pairs than are kept at a time.
TEST(MatcherTest, AgreesWithAScanOfEverythingForManyPairs) {
  const std::string name = "robots/a/journeys/1";
  std::mt19937_64 engine(5);
  const JourneyMap map = RandomMap(engine, 2.2, 4000);
  const JourneyRef journey{&name, &map};
  SeenSides seen = RandomSeen(engine, 100);
  while (seen[0].size() < 90 || seen[1].size() < 90) seen = RandomSeen(engine, 100);
  Matcher matcher;
  for (const MatchOptions options : {MatchOptions{1000, 0}, MatchOptions{1000, 0.2}}) {
    ExpectSame(matcher.Find({&journey, 1}, seen, options),
               NaiveMatches({&journey, 1}, seen, options));
  }
}

class Cancelled : public Cancellation {
 public:
  bool IsCancelled() const override { return true; }
};

TEST(MatcherTest, EndsWhenItIsCancelled) {
  const std::string name = "robots/a/journeys/1";
  std::mt19937_64 engine(5);
  const JourneyMap map = RandomMap(engine, 2.2);
  const JourneyRef journey{&name, &map};
  const SeenSides seen = RandomSeen(engine, 10);
  const Cancelled cancelled;
  Matcher matcher;
  EXPECT_TRUE(matcher.Find({&journey, 1}, seen, {10, 0}, &cancelled).empty());
  EXPECT_FALSE(matcher.Find({&journey, 1}, seen, {10, 0}).empty());
}

TEST(MatcherTest, BestWithinAnIntervalIsTheBestOfItsSteps) {
  std::mt19937_64 engine(7);
  const JourneyMap map = RandomMap(engine, 2.24);
  const std::string name = "n";
  const JourneyRef journey{&name, &map};
  SeenSides seen;
  seen[0].resize(1);
  seen[0][0].x = 20;
  seen[0][0].y = 15;
  seen[0][0].count = 25;
  Matcher matcher;
  const auto all = matcher.Find({&journey, 1}, seen, {.max_matches = 1, .threshold = 0});
  ASSERT_EQ(all.size(), 1u);
  const auto here = matcher.FindBestWithin(journey, all[0].step, all[0].step, seen, 0);
  ASSERT_TRUE(here);
  EXPECT_EQ(here->similarity.p_t, all[0].similarity.p_t);
  EXPECT_FALSE(matcher.FindBestWithin(journey, all[0].step, all[0].step, seen, 1).has_value());
  EXPECT_FALSE(matcher.FindBestWithin(journey, 0, 59, SeenSides{}, 0).has_value());
}

TEST(MatcherTest, ReturningRobotsCamerasHaveChangedSides) {
  EXPECT_EQ(RouteSide(Side::kLeft, Travel::kReturn), Side::kRight);
  EXPECT_EQ(RouteSide(Side::kRight, Travel::kReturn), Side::kLeft);
  EXPECT_EQ(RouteSide(Side::kLeft, Travel::kSame), Side::kLeft);
  EXPECT_EQ(RouteSide(Side::kRight, Travel::kSame), Side::kRight);
}

TEST(MatchOptionsTest, NamesTheOptionThatIsOutOfRange) {
  EXPECT_THAT(Validate(MatchOptions{}), IsOk());
  EXPECT_THAT(Validate(MatchOptions{.max_matches = 0}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("max_matches: 0")));
  EXPECT_THAT(Validate(MatchOptions{.threshold = 1.5}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("threshold: 1.5")));
}

}  // namespace
}  // namespace homing
