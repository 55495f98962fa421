// The results of the benchmarks: one number a repetition, by name.
#ifndef TESTS_BENCHMARK_RESULTS_H_
#define TESTS_BENCHMARK_RESULTS_H_

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace homing::benchmarks {

// REQUIRES: not empty.
double MedianOf(std::vector<double> values);

// Of one benchmark, in the order of its repetitions.
struct Series {
  // Seconds an iteration.
  std::vector<double> wall_s;
  std::vector<double> cpu_s;
  std::map<std::string, std::vector<double>> counters;
};

class Results {
 public:
  // Empty where nothing of that name was measured.
  const Series& Of(const std::string& name) const;
  Series& At(const std::string& name) { return series_[name]; }

 private:
  std::map<std::string, Series> series_;
};

// Prints and keeps the results of Google Benchmark.
class KeepingReporter : public benchmark::ConsoleReporter {
 public:
  // `results` must outlive it.
  explicit KeepingReporter(Results* results)
      : benchmark::ConsoleReporter(OO_None), results_(results) {}
  void ReportRuns(const std::vector<Run>& runs) override;

 private:
  Results* const results_;
};

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_RESULTS_H_
