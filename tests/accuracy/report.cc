#include "tests/accuracy/report.h"

#include "absl/strings/str_format.h"
#include "tests/accuracy/report_draft.h"

namespace homing::accuracy {
namespace {

// The growth is between the first and the last, against that of the steps.
void ReportLongJourneys(Draft& draft) {
  const auto& all = draft.measurements().long_journeys;
  if (all.size() < 2) return;
  draft.Write("## Long journeys\n\n| steps | us a camera and observation |\n|---|---|\n");
  for (const auto& [steps, microseconds] : all) {
    draft.Write(absl::StrFormat("| %d | %.0f |\n", steps, microseconds));
  }
  draft.Write("\n");
  const auto steps = [&all](std::size_t i) { return static_cast<double>(all[i].first); };
  draft.AtMost(absl::StrFormat("us a camera at %d steps", all.back().first), all.back().second,
               300);
  draft.AtMost("growth of that over growth of the steps",
               all.back().second / all.front().second / (steps(all.size() - 1) / steps(0)), 1);
}

void ReportFleet(Draft& draft) {
  const FleetResult& fleet = draft.measurements().fleet;
  if (fleet.robots == 0) return;
  draft.Write(absl::StrFormat(
      "## A fleet\n\n%d journeys of 500 m in one store, flow projected from corners with noise "
      "and\n"
      "clutter; each robot comes home along its own without naming it, 25 %% faster and 0.5 m "
      "aside.\n"
      "After 15 m, journey right and step within 1 m: %d of %d; %d of these as MATCH.\n\n",
      fleet.robots, fleet.right, fleet.robots, fleet.sure));
  draft.AtLeast("fleet: journey and step right after 15 m", fleet.share(), 0.95);
}

}  // namespace

Report MakeReport(const Measurements& measurements) {
  Draft draft(measurements);
  ReportReal(draft);
  ReportHonesty(draft);
  ReportForeign(draft);
  ReportSimulated(draft);
  ReportLost(draft);
  ReportLongJourneys(draft);
  ReportFleet(draft);
  return draft.Take();
}

}  // namespace homing::accuracy
