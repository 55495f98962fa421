// Whether a probability means what it says.
#include "absl/strings/str_format.h"
#include "tests/accuracy/honesty.h"
#include "tests/accuracy/report_draft.h"
#include "tests/accuracy/scores.h"

namespace homing::accuracy {
namespace {

constexpr double kMatchRight = 0.97;
// A pass with fewer MATCH answers may have so many wrong ones.
constexpr int kManyMatches = 100;
constexpr double kMostWrong = 3;
constexpr double kCalibrationError = 0.05;
constexpr double kMatchShare = 0.60;

constexpr char kHead[] =
    "Right is within 1.5 tolerances where the truth was found by comparing pictures. The error of\n"
    "calibration is that expected over ten bins of equal mass; the perfect one is the mean error "
    "of\n"
    "as many answers that are right just as often as they say.\n\n"
    "| answers | MATCH | of these right | error | perfect | Brier score "
    "|\n|---|---|---|---|---|---|\n";

void Row(Draft& draft, const std::string& name, const Group& group) {
  const MatchCount count = CountMatches(group);
  const auto judgements = JudgeEnough(group);
  const Calibration calibration = CalibrationOf(judgements);
  draft.Write(absl::StrFormat("| %s | %.3f | %.4f | %.3f | %.3f | %.3f |\n", name,
                              count.MatchShare(), count.RightShare(), calibration.expected_error,
                              PerfectCalibrationError(judgements), calibration.brier));
}

void BoundSet(Draft& draft, const std::string& set) {
  const Group& group = draft.Of(set);
  const MatchCount count = CountMatches(group);
  if (count.matches >= kManyMatches) {
    draft.AtLeast(set + " MATCH right", count.RightShare(), kMatchRight);
  } else {
    draft.AtMost(set + " MATCH wrong", count.wrong(), kMostWrong);
  }
  const auto judgements = JudgeEnough(group);
  draft.AtMost(set + " calibration error over the perfect one",
               CalibrationOf(judgements).expected_error - PerfectCalibrationError(judgements),
               kCalibrationError);
}

}  // namespace

void ReportHonesty(Draft& draft) {
  Group real;
  Group simulated;
  Group all;
  std::vector<double> match_shares;
  draft.Write("## Calibration\n\n");
  draft.Write(kHead);
  for (const std::string& set : draft.sets()) {
    const Group& group = draft.Of(set);
    all.insert(all.end(), group.begin(), group.end());
    if (draft.IsReal(set)) {
      real.insert(real.end(), group.begin(), group.end());
      Row(draft, set, group);
      BoundSet(draft, set);
      if (draft.IsPass(set)) match_shares.push_back(CountMatches(group).MatchShare());
    } else if (!group[0]->real && !set.ends_with("kidnapped")) {
      simulated.insert(simulated.end(), group.begin(), group.end());
    }
  }
  if (!real.empty()) {
    Row(draft, "real", real);
    draft.AtLeast("real MATCH right", CountMatches(real).RightShare(), kMatchRight);
    draft.AtMost("real calibration error", CalibrationOf(JudgeEnough(real)).expected_error,
                 kCalibrationError);
  }
  if (!match_shares.empty()) {
    draft.AtLeast("real passes, mean share of MATCH", Mean(match_shares), kMatchShare);
  }
  if (!simulated.empty()) {
    Row(draft, "simulated", simulated);
    draft.AtMost("simulated calibration error",
                 CalibrationOf(JudgeEnough(simulated)).expected_error, kCalibrationError);
  }
  draft.AtMost("answers whose outcome, probability and on_route disagree", CountDisagreements(all),
               0);
  draft.Write("\n");
}

}  // namespace homing::accuracy
