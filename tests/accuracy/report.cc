#include "tests/accuracy/report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "absl/strings/str_format.h"
#include "tests/accuracy/scores.h"
#include "tests/accuracy/simulated_runs.h"

namespace homing::accuracy {
namespace {

using Group = std::vector<const Run*>;

const std::vector<std::string> kReal = {"laps", "laps dim", "gantry", "shop"};
const std::vector<std::string> kConditions = {"same",   "fast",   "near",   "dark", "bright",
                                              "return", "remove", "wobble", "stop", "two"};
constexpr double kRecall = 0.98;
constexpr double kWorstRecall = 0.90;
constexpr double kHomewardM = 20;
constexpr double kAgainM = 10;
// Of fewer worlds a mean over one condition says little: it is taken over all conditions of a
// scene.
constexpr std::size_t kWorldsForAMean = 10;

std::map<std::string, Group> GroupsOf(const std::vector<Run>& runs) {
  std::map<std::string, Group> groups;
  for (const Run& run : runs) groups[run.set].push_back(&run);
  return groups;
}

double RecallOf(const Group& group, const Answers Run::*method) {
  return Recall(Judge(group, method));
}

double WorstRecall(const Group& group) {
  double worst = 1;
  for (const Run* run : group) worst = std::min(worst, RecallOf({run}, &Run::homing));
  return worst;
}

// Right at the instant that is 10 m after the jump.
bool FoundAgain(const Run& run) {
  const std::size_t jump = JumpOf(run);
  std::size_t i = jump;
  while (i + 1 < run.query.size() &&
         std::abs(run.query[i]->place - run.query[jump]->place) < kAgainM) {
    ++i;
  }
  return run.Right(run.homing[i], i);
}

bool KnownAsForeign(const Run& run) {
  for (std::size_t i = 0;
       i < run.query.size() && std::abs(run.query[i]->place - run.query[0]->place) <= kHomewardM;
       ++i) {
    if (run.homing[i].outcome == Outcome::kUnknownPlace) return true;
  }
  return false;
}

template <typename Predicate>
double ShareOf(const Group& group, Predicate holds) {
  const auto count = std::ranges::count_if(group, [&](const Run* run) { return holds(*run); });
  return group.empty() ? 0 : static_cast<double>(count) / static_cast<double>(group.size());
}

// "0.97 (0.99, 0.62)": recall, area of precision-recall, recall at full precision.
std::string Cell(const Group& group, const Answers Run::*method) {
  const auto judgements = Judge(group, method);
  const PrecisionRecall curve = PrecisionRecallOf(judgements);
  return absl::StrFormat("%.3f (%.3f, %.2f)", Recall(judgements), curve.area,
                         curve.recall_at_full_precision);
}

class Writer {
 public:
  explicit Writer(const Measurements& measurements)
      : measurements_(measurements), groups_(GroupsOf(measurements.runs)) {}

  Report Write() {
    Real();
    Simulated();
    Lost();
    LongJourneys();
    Fleet();
    Calibrated();
    return std::move(report_);
  }

 private:
  void Add(const std::string& name, double value, double bound, bool at_least = true) {
    report_.bounds.push_back({name, value, bound, at_least});
  }

  bool IsQuick() const {
    const auto group = groups_.find("street same");
    return group == groups_.end() || group->second.size() < kWorldsForAMean;
  }

  void Comparison(const std::vector<std::string>& sets) {
    report_.markdown +=
        "| sequence | runs | answers | Homing | pictures, same filter | SeqSLAM, 5 | SeqSLAM, 10 | "
        "best P_T alone |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const std::string& set : sets) {
      if (!groups_.contains(set)) continue;
      const Group& group = groups_.at(set);
      report_.markdown +=
          absl::StrFormat("| %s | %d | %d | %s | %s | %s | %s | %s |\n", set, group.size(),
                          Judge(group, &Run::homing).size(), Cell(group, &Run::homing),
                          Cell(group, &Run::pictures), Cell(group, &Run::seq_slam_5),
                          Cell(group, &Run::seq_slam_10), Cell(group, &Run::single_frame));
    }
    report_.markdown += "\n";
  }

  void Real() {
    report_.markdown += "## Real sequences\n\n";
    Comparison(kReal);
    report_.markdown +=
        "| sequence | MATCH | of these right | median error | first right MATCH | bytes a camera "
        "and step | us an observation |\n|---|---|---|---|---|---|---|\n";
    for (const std::string& set : kReal) {
      if (!groups_.contains(set)) continue;
      const Group& group = groups_.at(set);
      Detail(set, group);
      const auto homing = Judge(group, &Run::homing);
      const auto pictures = Judge(group, &Run::pictures);
      for (const auto method : {&Run::seq_slam_5, &Run::seq_slam_10}) {
        const auto peer = Judge(group, method);
        const std::string name = method == &Run::seq_slam_5 ? "5" : "10";
        Add(set + " recall against SeqSLAM " + name, Recall(homing), Recall(peer));
        Add(set + " area against SeqSLAM " + name, PrecisionRecallOf(homing).area,
            PrecisionRecallOf(peer).area);
      }
      if (set.starts_with("laps")) {
        Add(set + " recall against 0.95 of pictures", Recall(homing), 0.95 * Recall(pictures));
      }
    }
    report_.markdown += "\n";
  }

  void Detail(const std::string& set, const Group& group) {
    double matches = 0;
    double right = 0;
    double all = 0;
    for (const Run* run : group) {
      for (std::size_t i = 0; i < run->homing.size(); ++i) {
        if (!run->Judged(i)) continue;
        all += 1;
        if (run->homing[i].outcome != Outcome::kMatch) continue;
        matches += 1;
        right += run->Right(run->homing[i], i) ? 1 : 0;
      }
    }
    report_.markdown += absl::StrFormat(
        "| %s | %.3f | %s | %.2f | %.0f | %s | %s |\n", set, all > 0 ? matches / all : 0,
        matches > 0 ? absl::StrFormat("%.4f", right / matches) : "-",
        MedianError(group, &Run::homing), MedianTimeToMatch(group),
        Figure(measurements_.bytes, set, "%.0f"), Figure(measurements_.microseconds, set, "%.0f"));
  }

  static std::string Figure(const std::vector<std::pair<std::string, double>>& all,
                            const std::string& name, const char* /*format*/) {
    for (const auto& [key, value] : all) {
      if (key == name) return absl::StrFormat("%.0f", value);
    }
    return "";
  }

  void Simulated() {
    report_.markdown += "## Simulated routes of 60 m\n\n";
    for (const std::string scene : {"street", "landmarks"}) {
      std::vector<std::string> sets;
      for (const std::string& condition : kConditions) sets.push_back(scene + " " + condition);
      Comparison(sets);
      report_.markdown +=
          "| condition | worst seed | MATCH | of these right | median error, m | first right MATCH "
          "| bytes a "
          "camera and step | us an observation |\n|---|---|---|---|---|---|---|---|\n";
      Group scene_runs;
      for (const std::string& set : sets) {
        if (!groups_.contains(set)) continue;
        const Group& group = groups_.at(set);
        scene_runs.insert(scene_runs.end(), group.begin(), group.end());
        const double worst = WorstRecall(group);
        Detail(absl::StrFormat("%s | %.3f", set, worst), group);
        if (IsQuick()) continue;
        Add(set + " recall", RecallOf(group, &Run::homing), kRecall);
        Add(set + " worst seed", worst, kWorstRecall);
      }
      if (IsQuick() && !scene_runs.empty()) {
        Add(scene + " recall, all conditions", RecallOf(scene_runs, &Run::homing), kRecall);
        Add(scene + " worst run", WorstRecall(scene_runs), kWorstRecall);
      }
      report_.markdown += "\n";
    }
  }

  void Lost() {
    report_.markdown +=
        "## Lost\n\n| scene | foreign: MATCH | foreign: UNKNOWN_PLACE within 20 m | kidnapped: "
        "right "
        "after 10 m |\n|---|---|---|---|\n";
    for (const std::string scene : {"street", "landmarks"}) {
      if (!groups_.contains(scene + " foreign")) continue;
      const Group& foreign = groups_.at(scene + " foreign");
      const double match = Share(foreign, Outcome::kMatch);
      const double unknown = ShareOf(foreign, KnownAsForeign);
      const double again = ShareOf(groups_.at(scene + " kidnapped"), FoundAgain);
      report_.markdown +=
          absl::StrFormat("| %s | %.4f | %.2f | %.3f |\n", scene, match, unknown, again);
      Add(scene + " foreign MATCH", match, 0.01, false);
      Add(scene + " foreign UNKNOWN_PLACE within 20 m", unknown, 0.95);
      Add(scene + " kidnapped right after 10 m", again, 0.95);
    }
    report_.markdown += "\n";
  }

  // The growth is between the first and the last, against that of the steps.
  void LongJourneys() {
    const auto& all = measurements_.long_journeys;
    if (all.size() < 2) return;
    report_.markdown += "## Long journeys\n\n| steps | us a camera and observation |\n|---|---|\n";
    for (const auto& [steps, microseconds] : all) {
      report_.markdown += absl::StrFormat("| %d | %.0f |\n", steps, microseconds);
    }
    report_.markdown += "\n";
    const auto steps = [&all](std::size_t i) { return static_cast<double>(all[i].first); };
    Add(absl::StrFormat("us a camera at %d steps", all.back().first), all.back().second, 300,
        false);
    Add("growth of that over growth of the steps",
        all.back().second / all.front().second / (steps(all.size() - 1) / steps(0)), 1, false);
  }

  void Fleet() {
    const FleetResult& fleet = measurements_.fleet;
    if (fleet.robots == 0) return;
    report_.markdown += absl::StrFormat(
        "## A fleet\n\n%d journeys of 500 m in one store, flow projected from corners with noise "
        "and "
        "clutter; each robot comes home along its own without naming it, 25 %% faster and 0.5 m "
        "aside. After 15 m, journey right and step within 1 m: %d of %d; %d of these as MATCH.\n\n",
        fleet.robots, fleet.right, fleet.robots, fleet.sure);
    Add("fleet: journey and step right after 15 m", fleet.share(), 0.95);
  }

  void Calibrated() {
    Group simulated;
    Group real;
    for (const auto& [set, group] : groups_) {
      const bool is_real = std::ranges::find(kReal, set) != kReal.end();
      if (set.ends_with("kidnapped")) continue;
      Group& all = is_real ? real : simulated;
      all.insert(all.end(), group.begin(), group.end());
    }
    report_.markdown +=
        "## Calibration\n\nExpected error over ten bins of equal mass, all answers.\n\n| answers | "
        "expected "
        "error | Brier score |\n|---|---|---|\n";
    const auto row = [this](const std::string& name, const Group& group) {
      const Calibration calibration = CalibrationOf(Judge(group, &Run::homing));
      report_.markdown += absl::StrFormat("| %s | %.3f | %.3f |\n", name,
                                          calibration.expected_error, calibration.brier);
      return calibration.expected_error;
    };
    if (!simulated.empty())
      Add("simulated calibration error", row("simulated", simulated), 0.05, false);
    if (!real.empty()) Add("real calibration error", row("real", real), 0.10, false);
    for (const std::string& set : kReal) {
      if (groups_.contains(set)) row(set, groups_.at(set));
    }
    report_.markdown += "\n";
  }

  const Measurements& measurements_;
  std::map<std::string, Group> groups_;
  Report report_;
};

}  // namespace

Report MakeReport(const Measurements& measurements) { return Writer(measurements).Write(); }

}  // namespace homing::accuracy
