// The bounds that must hold, each judged by a bootstrap interval over its repetitions.
// The interval after Efron, "Bootstrap methods", 1979.
#ifndef TESTS_BENCHMARK_ROWS_H_
#define TESTS_BENCHMARK_ROWS_H_

#include <string>
#include <vector>

#include "tests/benchmark/results.h"

namespace homing::benchmarks {

enum class Verdict { kOk, kShort, kUnsure };

struct Row {
  std::string name;
  // A description of the two compared values, for the report.
  std::string meaning;
  // Median, and the ends of its 95 % interval.
  double value = 0;
  double low = 0;
  double high = 0;
  double bound = 0;
  // The value is to be at least the bound; else at most.
  bool at_least = true;
  int repeats = 0;
  Verdict verdict = Verdict::kUnsure;
};

const char* Word(Verdict verdict);

// Of one value a repetition. A row is short only if its interval lies wholly on the wrong side.
// REQUIRES: not empty.
Row Judge(Row row, const std::vector<double>& values);

// a[i] / b[i], as far as both go.
std::vector<double> Quotients(const std::vector<double>& a, const std::vector<double>& b);

// a[i] - b[i], as far as both go.
std::vector<double> Differences(const std::vector<double>& a, const std::vector<double>& b);

// The rows for these results; values that were not measured have no row.
std::vector<Row> AllRows(const Results& results);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_ROWS_H_
