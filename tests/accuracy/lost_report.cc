// Robots that are not on the route, or not where they were.
#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "tests/accuracy/report_draft.h"
#include "tests/accuracy/scores.h"
#include "tests/accuracy/simulated_runs.h"

namespace homing::accuracy {
namespace {

constexpr double kForeignMatch = 0.01;
constexpr double kForeignMatchOfOne = 0.03;
constexpr double kForeignUnknown = 0.90;
constexpr double kKnownAfterM = 20;
constexpr double kAgainM = 10;

// Right at the instant that is 10 m after the jump.
bool IsFoundAgain(const Run& run) {
  const std::size_t jump = JumpOf(run);
  std::size_t i = jump;
  while (i + 1 < run.query.size() &&
         std::abs(run.query[i]->place - run.query[jump]->place) < kAgainM) {
    ++i;
  }
  return run.Right(run.homing[i], i);
}

bool IsKnownAsForeign(const Run& run) {
  for (std::size_t i = 0;
       i < run.query.size() && std::abs(run.query[i]->place - run.query[0]->place) <= kKnownAfterM;
       ++i) {
    if (run.homing[i].outcome == Outcome::kUnknownPlace) return true;
  }
  return false;
}

// UNKNOWN_PLACE at the last instant within 20 m of the end.
bool IsKnownAsBeyond(const Run& run) {
  std::size_t i = 0;
  while (i + 1 < run.query.size() && run.Beyond(i + 1) <= kKnownAfterM) ++i;
  return run.homing[i].outcome == Outcome::kUnknownPlace;
}

// Of the answers from 20 m beyond the end on.
double UnknownBeyond(const Group& group) {
  double unknown = 0;
  double all = 0;
  for (const Run* run : group) {
    for (std::size_t i = 0; i < run->query.size(); ++i) {
      if (run->Beyond(i) <= kKnownAfterM) continue;
      all += 1;
      unknown += run->homing[i].outcome == Outcome::kUnknownPlace ? 1 : 0;
    }
  }
  return all > 0 ? unknown / all : 0;
}

struct Worst {
  double value = 0;
  std::string set;
};

// The greatest share of MATCH on one route.
Worst MostMatches(const Group& group) {
  Worst worst;
  for (const Run* run : group) {
    const double share = Share({run}, Outcome::kMatch);
    if (worst.set.empty() || share > worst.value) worst = {share, run->set};
  }
  return worst;
}

// A route that the map does not know, of the same camera.
bool IsOwnForeign(const Run& run) { return run.real && std::ranges::count(run.set, ' ') == 1; }

void BoundForeign(Draft& draft, const std::string& name, const Group& group) {
  if (group.empty()) return;
  draft.AtMost(name + " MATCH on the worst route", MostMatches(group).value, kForeignMatchOfOne);
  draft.AtLeast(name + " UNKNOWN_PLACE", LateShare(group, Outcome::kUnknownPlace), kForeignUnknown);
}

}  // namespace

void ReportForeign(Draft& draft) {
  Group all;
  Group crossed;
  draft.Write(
      "## Foreign routes\n\nUNKNOWN_PLACE: of the answers from the 50th on, from the middle of a "
      "shorter "
      "route.\n\n| route | runs | MATCH | worst run | UNKNOWN_PLACE |\n|---|---|---|---|---|\n");
  const auto row = [&draft](const std::string& name, const Group& group) {
    draft.Write(absl::StrFormat("| %s | %d | %.4f | %.4f | %.3f |\n", name, group.size(),
                                Share(group, Outcome::kMatch), MostMatches(group).value,
                                LateShare(group, Outcome::kUnknownPlace)));
  };
  for (const std::string& set : draft.sets()) {
    const Group& group = draft.Of(set);
    if (!group[0]->foreign) continue;
    all.insert(all.end(), group.begin(), group.end());
    row(set, group);
    if (group[0]->real && !IsOwnForeign(*group[0])) {
      crossed.insert(crossed.end(), group.begin(), group.end());
    } else {
      BoundForeign(draft, set, group);
    }
  }
  BoundForeign(draft, "foreign, other cameras' routes", crossed);
  if (!all.empty()) {
    draft.AtMost("foreign MATCH, all routes", Share(all, Outcome::kMatch), kForeignMatch);
    row("all", all);
  }
  draft.Write("\n");
}

void ReportLost(Draft& draft) {
  draft.Write("## Lost\n\n| robots | runs | figure |\n|---|---|---|\n");
  const auto report = [&draft](const std::string& name, const Group& group, double value,
                               double bound) {
    draft.AtLeast(name, value, bound);
    draft.Write(absl::StrFormat("| %s | %d | %.3f |\n", name, group.size(), value));
  };
  for (const std::string scene : {"street", "landmarks"}) {
    if (const Group& foreign = draft.Of(scene + " foreign"); !foreign.empty()) {
      report(scene + " foreign UNKNOWN_PLACE within 20 m", foreign,
             FractionOf(foreign, IsKnownAsForeign), 0.95);
    }
    if (const Group& moved = draft.Of(scene + " kidnapped"); !moved.empty()) {
      report(scene + " kidnapped right after 10 m", moved, FractionOf(moved, IsFoundAgain), 0.95);
    }
    for (const char* end : {" past the far end", " past home"}) {
      const Group& past = draft.Of(scene + end);
      if (past.empty()) continue;
      report(scene + end + " UNKNOWN_PLACE at 20 m", past, FractionOf(past, IsKnownAsBeyond), 1);
      draft.Write(absl::StrFormat("| %s UNKNOWN_PLACE from 20 to 40 m | %d | %.3f |\n", scene + end,
                                  past.size(), UnknownBeyond(past)));
    }
  }
  draft.Write("\n");
}

}  // namespace homing::accuracy
