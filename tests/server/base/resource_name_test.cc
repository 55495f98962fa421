#include "server/base/resource_name.h"

#include <string>

#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

TEST(ResourceNameTest, AJourneyNameIsTakenApartAndPutTogether) {
  const auto name = ParseJourneyName("robots/r-1/journeys/Out_2.b", "name");
  ASSERT_THAT(name, IsOk());
  EXPECT_EQ(name->robot, "r-1");
  EXPECT_EQ(name->journey, "Out_2.b");
  EXPECT_EQ(name->ToString(), "robots/r-1/journeys/Out_2.b");
}

TEST(ResourceNameTest, WrongNamesAreRefusedWithFieldAndValue) {
  for (const char* bad :
       {"", "robots/r", "robots/r/journeys/", "robots//journeys/j", "robots/r/journeys/j/k",
        "robot/r/journeys/j", "robots/r/journeys/a b", "robots/r/journeys/\xc3\xa9",
        "robots/../journeys/j/..", "/robots/r/journeys/j"}) {
    EXPECT_THAT(ParseJourneyName(bad, "the_field"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("the_field: ")))
        << bad;
  }
}

TEST(ResourceNameTest, AnIdHasAtMost63Characters) {
  EXPECT_THAT(CheckId(std::string(63, 'a'), "id"), IsOk());
  EXPECT_THAT(CheckId(std::string(64, 'a'), "id"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("1 to 63")));
}

TEST(ResourceNameTest, NewIdsDoNotBeginAsPathsOrFlagsDo) {
  for (const char* bad : {".", "..", "...", ".hidden", "-r", "--help"}) {
    EXPECT_THAT(CheckNewId(bad, "journey_id"),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         HasSubstr("the first is a letter, a digit or \"_\"")))
        << bad;
    EXPECT_THAT(CheckNewJourney({bad, "j"}, "parent", "journey_id"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("parent: ")));
    EXPECT_THAT(CheckNewJourney({"r", bad}, "parent", "journey_id"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("journey_id: ")));
    // One of an older version can still be deleted.
    EXPECT_THAT(ParseJourneyName(std::string("robots/r/journeys/") + bad, "name"), IsOk());
  }
  for (const char* good : {"a", "7", "_x", "a..b", "a-"}) {
    EXPECT_THAT(CheckNewId(good, "id"), IsOk()) << good;
  }
}

TEST(ResourceNameTest, TheWildcardIsAllowedInPatternsOnly) {
  EXPECT_THAT(ParseJourneyPattern("robots/-/journeys/-", "journey"), IsOk());
  EXPECT_THAT(ParseJourneyName("robots/r/journeys/-", "name"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("wildcard")));
  EXPECT_THAT(ParseRobotName("robots/-", "parent", true), IsOk());
  EXPECT_THAT(ParseRobotName("robots/-", "parent", false),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("parent")));
}

TEST(ResourceNameTest, APatternCoversTheNamesItMatches) {
  const JourneyName journey{"r", "j"};
  EXPECT_TRUE(Covers({"-", "-"}, journey));
  EXPECT_TRUE(Covers({"r", "-"}, journey));
  EXPECT_TRUE(Covers({"-", "j"}, journey));
  EXPECT_TRUE(Covers({"r", "j"}, journey));
  EXPECT_FALSE(Covers({"s", "-"}, journey));
  EXPECT_FALSE(Covers({"-", "k"}, journey));
}

}  // namespace
}  // namespace homing::server
