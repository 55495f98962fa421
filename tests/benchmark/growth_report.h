// Throughput, latency and memory by the number of robots: a table and three plots.
#ifndef TESTS_BENCHMARK_GROWTH_REPORT_H_
#define TESTS_BENCHMARK_GROWTH_REPORT_H_

#include <string>
#include <utility>
#include <vector>

#include "tests/benchmark/results.h"

namespace homing::benchmarks {

struct GrowthReport {
  // Markdown; empty if nothing was measured.
  std::string text;
  // The name of each picture in images/, and its SVG.
  std::vector<std::pair<std::string, std::string>> pictures;
};

// Of the runs growth_echo/N, growth_record/N and growth_localize/N of N robots.
GrowthReport ReportGrowth(const Results& results);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_GROWTH_REPORT_H_
