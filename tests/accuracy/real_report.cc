// Real routes: recall beside that of pictures, and how soon a robot knows where it is.
#include <algorithm>
#include <cmath>

#include "tests/accuracy/report_draft.h"
#include "tests/accuracy/scores.h"

namespace homing::accuracy {
namespace {

constexpr double kBehindPictures = 0.03;
constexpr double kMeanRecall = 0.94;
// A robot whose map is of another run, in other light, and whose motion is five times smaller.
constexpr char kHardest[] = "humanoid";
constexpr double kHardestRecall = 0.60;
constexpr double kRowsRecall = 0.99;
// Of the map's steps; or as many observations.
constexpr double kFirstMatch = 0.03;
constexpr double kFirstMatchObservations = 5;

void BoundRecall(Draft& draft, const std::vector<std::string>& sets) {
  std::vector<double> recalls;
  for (const std::string& set : sets) {
    const Group& group = draft.Of(set);
    const double recall = RecallOf(group, &Run::homing);
    if (set.starts_with(kHardest)) {
      draft.AtLeast(set + " recall", recall, kHardestRecall);
    } else if (!draft.IsPass(set)) {
      draft.AtLeast(set + " recall", recall, kRowsRecall);
    } else {
      recalls.push_back(recall);
      if (draft.measurements().has_peers) {
        draft.AtLeast(set + " recall against pictures", recall,
                      RecallOf(group, &Run::pictures) - kBehindPictures);
      }
    }
  }
  if (!recalls.empty()) draft.AtLeast("real passes, mean recall", Mean(recalls), kMeanRecall);
}

void BoundFirstMatch(Draft& draft, const std::vector<std::string>& sets) {
  std::vector<double> times;
  for (const std::string& set : sets) {
    if (!draft.IsPass(set)) continue;
    const Run& run = *draft.Of(set)[0];
    const double observations = TimeToMatch(run);
    const double share = observations / static_cast<double>(StepsOf(*run.maps[0]).size());
    times.push_back(observations <= kFirstMatchObservations ? std::min(share, kFirstMatch) : share);
  }
  if (!times.empty()) {
    draft.AtMost("first right MATCH, observations over steps", Median(times), kFirstMatch);
  }
}

void BoundAgainstSeqSlam(Draft& draft, const std::string& set) {
  const Group& group = draft.Of(set);
  if (group.empty() || !draft.measurements().has_peers) return;
  const auto homing = Judge(group, &Run::homing);
  for (const auto& [name, method] :
       {std::pair("5", &Run::seq_slam_5), std::pair("10", &Run::seq_slam_10)}) {
    const auto peer = Judge(group, method);
    draft.AtLeast(set + " recall against SeqSLAM " + name, Recall(homing), Recall(peer));
    draft.AtLeast(set + " area against SeqSLAM " + name, PrecisionRecallOf(homing).area,
                  PrecisionRecallOf(peer).area);
  }
}

}  // namespace

void ReportReal(Draft& draft) {
  std::vector<std::string> sets;
  for (const std::string& set : draft.sets()) {
    if (draft.IsReal(set)) sets.push_back(set);
  }
  if (sets.empty()) return;
  draft.Write("## Real sequences\n\n");
  draft.Comparison(sets);
  draft.Details(sets);
  BoundRecall(draft, sets);
  BoundFirstMatch(draft, sets);
  for (const char* set : {"laps", "laps dim", "gantry", "shop"}) BoundAgainstSeqSlam(draft, set);
}

}  // namespace homing::accuracy
