// docs/performance.md and its pictures.
#ifndef TESTS_BENCHMARK_REPORT_H_
#define TESTS_BENCHMARK_REPORT_H_

#include <string>
#include <vector>

#include "tests/benchmark/rows.h"

namespace homing::benchmarks {

struct ReportOptions {
  // The Markdown file; pictures go to images/ beside it. Empty: none is written.
  std::string path;
  // As typed.
  std::string command;
};

// False: a file could not be written.
bool WriteReport(const ReportOptions& options, const Results& results,
                 const std::vector<Row>& rows);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_REPORT_H_
