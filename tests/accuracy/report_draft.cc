#include "tests/accuracy/report_draft.h"

#include <algorithm>

#include "tests/accuracy/honesty.h"
#include "tests/accuracy/scores.h"

namespace homing::accuracy {
namespace {

// "0.97 (0.99, 0.62)": recall, area of precision-recall, recall at full precision.
std::string Cell(const Group& group, const Answers Run::*method) {
  const auto judgements = Judge(group, method);
  if (judgements.empty()) return "-";
  const PrecisionRecall curve = PrecisionRecallOf(judgements);
  return absl::StrFormat("%.3f (%.3f, %.2f)", Recall(judgements), curve.area,
                         curve.recall_at_full_precision);
}

std::string FigureOf(const std::vector<std::pair<std::string, double>>& all,
                     const std::string& name) {
  for (const auto& [key, value] : all) {
    if (key == name) return absl::StrFormat("%.0f", value);
  }
  return "";
}

}  // namespace

double RecallOf(const Group& group, const Answers Run::*method) {
  return Recall(Judge(group, method));
}

double WorstRecall(const Group& group) {
  double worst = 1;
  for (const Run* run : group) worst = std::min(worst, RecallOf({run}, &Run::homing));
  return worst;
}

Draft::Draft(const Measurements& measurements) : measurements_(measurements) {
  for (const Run& run : measurements.runs) {
    if (!groups_.contains(run.set)) sets_.push_back(run.set);
    groups_[run.set].push_back(&run);
  }
}

const Group& Draft::Of(const std::string& set) const {
  static const Group none;
  const auto found = groups_.find(set);
  return found == groups_.end() ? none : found->second;
}

bool Draft::IsReal(const std::string& set) const {
  const Group& group = Of(set);
  return !group.empty() && group[0]->real && !group[0]->foreign;
}

bool Draft::IsPass(const std::string& set) const { return IsReal(set) && Of(set).size() == 1; }

void Draft::Comparison(const std::vector<std::string>& sets) {
  Write(
      "| sequence | runs | answers | Homing | pictures, same filter | SeqSLAM, 5 | SeqSLAM, 10 | "
      "best P_T alone |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& set : sets) {
    const Group& group = Of(set);
    if (group.empty()) continue;
    Write(absl::StrFormat("| %s | %d | %d | %s | %s | %s | %s | %s |\n", set, group.size(),
                          Judge(group, &Run::homing).size(), Cell(group, &Run::homing),
                          Cell(group, &Run::pictures), Cell(group, &Run::seq_slam_5),
                          Cell(group, &Run::seq_slam_10), Cell(group, &Run::single_frame)));
  }
  Write("\n");
}

void Draft::Details(const std::vector<std::string>& sets) {
  Write(
      "| sequence | worst run | MATCH | of these right | median error | first right MATCH | bytes "
      "a "
      "camera and step | us an observation |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& set : sets) {
    const Group& group = Of(set);
    if (group.empty()) continue;
    const MatchCount count = CountMatches(group);
    Write(absl::StrFormat(
        "| %s | %.3f | %.3f | %s | %.2f | %.0f | %s | %s |\n", set, WorstRecall(group),
        count.MatchShare(),
        count.matches > 0 ? absl::StrFormat("%.4f", count.RightShare()) : std::string("-"),
        MedianError(group, &Run::homing), MedianTimeToMatch(group),
        FigureOf(measurements_.bytes, set), FigureOf(measurements_.microseconds, set)));
  }
  Write("\n");
}

}  // namespace homing::accuracy
