// A report while it is written: tables of many runs, and bounds.
#ifndef TESTS_ACCURACY_REPORT_DRAFT_H_
#define TESTS_ACCURACY_REPORT_DRAFT_H_

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "tests/accuracy/report.h"
#include "tests/accuracy/run.h"

namespace homing::accuracy {

using Group = std::vector<const Run*>;

double RecallOf(const Group& group, const Answers Run::*method);

// The least recall of Homing on one run.
double WorstRecall(const Group& group);

template <typename Predicate>
double FractionOf(const Group& group, Predicate holds) {
  double count = 0;
  for (const Run* run : group) count += holds(*run) ? 1 : 0;
  return group.empty() ? 0 : count / static_cast<double>(group.size());
}

class Draft {
 public:
  explicit Draft(const Measurements& measurements);

  const Measurements& measurements() const { return measurements_; }
  // Sets in the order of the runs.
  const std::vector<std::string>& sets() const { return sets_; }
  // Empty if there are no such runs.
  const Group& Of(const std::string& set) const;
  // Of a real route that the map knows.
  bool IsReal(const std::string& set) const;
  // Runs of one route: a pass.
  bool IsPass(const std::string& set) const;

  void AtLeast(const std::string& name, double value, double bound) {
    report_.bounds.push_back({name, value, bound, true});
  }
  void AtMost(const std::string& name, double value, double bound) {
    report_.bounds.push_back({name, value, bound, false});
  }
  void Write(const std::string& text) { report_.markdown += text; }
  // A table of all methods, a row a set; and what Homing gives beside its recall.
  void Comparison(const std::vector<std::string>& sets);
  void Details(const std::vector<std::string>& sets);

  Report Take() { return std::move(report_); }

 private:
  const Measurements& measurements_;
  std::vector<std::string> sets_;
  std::map<std::string, Group> groups_;
  Report report_;
};

// Each writes its part.
void ReportReal(Draft& draft);
void ReportHonesty(Draft& draft);
void ReportSimulated(Draft& draft);
void ReportForeign(Draft& draft);
void ReportLost(Draft& draft);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_REPORT_DRAFT_H_
