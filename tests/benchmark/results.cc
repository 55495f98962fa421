#include "tests/benchmark/results.h"

#include <algorithm>

namespace homing::benchmarks {

double MedianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

const Series& Results::Of(const std::string& name) const {
  static const Series* const none = new Series;
  const auto found = series_.find(name);
  return found == series_.end() ? *none : found->second;
}

void KeepingReporter::ReportRuns(const std::vector<Run>& runs) {
  benchmark::ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) {
      continue;
    }
    Series& series = results_->At(run.run_name.function_name +
                                  (run.run_name.args.empty() ? "" : "/" + run.run_name.args));
    const double iterations = static_cast<double>(run.iterations);
    series.wall_s.push_back(run.real_accumulated_time / iterations);
    series.cpu_s.push_back(run.cpu_accumulated_time / iterations);
    for (const auto& [name, counter] : run.counters) {
      series.counters[name].push_back(counter.value);
    }
  }
}

}  // namespace homing::benchmarks
