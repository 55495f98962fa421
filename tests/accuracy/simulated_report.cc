// Simulated routes under every condition.
#include <algorithm>
#include <span>

#include "tests/accuracy/report_draft.h"
#include "tests/accuracy/scores.h"
#include "tests/accuracy/simulated_runs.h"

namespace homing::accuracy {
namespace {

constexpr double kRecall = 0.98;
constexpr double kWorstRecall = 0.90;
constexpr double kMoreRecall = 0.95;
// Of fewer worlds a mean over one condition says little: it is taken over all conditions of a
// scene.
constexpr std::size_t kWorldsForAMean = 10;

std::vector<std::string> SetsOf(const std::string& scene, std::span<const char* const> conditions) {
  std::vector<std::string> sets;
  for (const char* condition : conditions) sets.push_back(scene + " " + condition);
  return sets;
}

Group All(const Draft& draft, const std::vector<std::string>& sets) {
  Group all;
  for (const std::string& set : sets) {
    all.insert(all.end(), draft.Of(set).begin(), draft.Of(set).end());
  }
  return all;
}

void BoundTogether(Draft& draft, const std::string& scene) {
  const Group all = All(draft, SetsOf(scene, kConditions));
  if (!all.empty()) {
    draft.AtLeast(scene + " recall, all conditions", RecallOf(all, &Run::homing), kRecall);
    draft.AtLeast(scene + " worst run", WorstRecall(all), kWorstRecall);
  }
  const Group more = All(draft, SetsOf(scene, kMoreConditions));
  if (!more.empty()) {
    draft.AtLeast(scene + " recall, more conditions", RecallOf(more, &Run::homing), kMoreRecall);
  }
}

void BoundEach(Draft& draft, const std::string& scene) {
  for (const std::string& set : SetsOf(scene, kConditions)) {
    if (draft.Of(set).empty()) continue;
    draft.AtLeast(set + " recall", RecallOf(draft.Of(set), &Run::homing), kRecall);
    draft.AtLeast(set + " worst seed", WorstRecall(draft.Of(set)), kWorstRecall);
  }
  for (const std::string& set : SetsOf(scene, kMoreConditions)) {
    if (draft.Of(set).empty()) continue;
    draft.AtLeast(set + " recall", RecallOf(draft.Of(set), &Run::homing), kMoreRecall);
  }
}

}  // namespace

void ReportSimulated(Draft& draft) {
  for (const std::string scene : {"street", "landmarks"}) {
    std::vector<std::string> sets = SetsOf(scene, kConditions);
    const auto more = SetsOf(scene, kMoreConditions);
    sets.insert(sets.end(), more.begin(), more.end());
    const Group all = All(draft, sets);
    if (all.empty()) continue;
    draft.Write("## Simulated: " + scene + "\n\n");
    draft.Comparison(sets);
    draft.Details(sets);
    std::size_t worlds = 0;
    for (const std::string& set : sets) worlds = std::max(worlds, draft.Of(set).size());
    if (worlds < kWorldsForAMean) {
      BoundTogether(draft, scene);
    } else {
      BoundEach(draft, scene);
    }
  }
}

}  // namespace homing::accuracy
