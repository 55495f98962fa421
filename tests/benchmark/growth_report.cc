#include "tests/benchmark/growth_report.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/benchmark/plot.h"

namespace homing::benchmarks {
namespace {

constexpr std::array<int, 8> kRobots = {10, 20, 50, 100, 200, 500, 1000, 2000};

struct Load {
  const char* name;
  const char* color;
};
constexpr std::array<Load, 3> kLoads = {
    Load{"echo", "#888888"}, {"record", "#1f77b4"}, {"localize", "#2ca02c"}};

struct Quantity {
  const char* counter;
  const char* picture;
  const char* title;
  const char* unit;
};
constexpr std::array<Quantity, 3> kQuantities = {
    Quantity{"per_second", "growth_throughput.svg", "Observations answered a second by robots",
             "observations a second"},
    {"p99_ms", "growth_p99.svg", "99th percentile of the latency by robots", "milliseconds"},
    {"mib", "growth_memory.svg", "Memory of the server by robots", "MiB"}};

// The median over the repeats; negative: not measured.
double Figure(const Results& results, const Load& load, int robots, const char* counter) {
  const auto& counters = results.Of(absl::StrCat("growth_", load.name, "/", robots)).counters;
  const auto found = counters.find(counter);
  return found == counters.end() ? -1 : MedianOf(found->second);
}

std::string TableRow(const Results& results, const Load& load, int robots) {
  if (Figure(results, load, robots, "per_second") < 0) return "";
  std::string row = absl::StrCat("| ", robots, " | ", load.name);
  for (const char* counter : {"per_second", "p99_ms", "cpu_us", "mib", "dropped"}) {
    absl::StrAppendFormat(&row, " | %.5g", Figure(results, load, robots, counter));
  }
  return row + " |\n";
}

std::string Plot(const Results& results, const Quantity& quantity) {
  std::vector<Curve> curves;
  for (const Load& load : kLoads) {
    Curve curve{load.name, load.color, {}};
    for (const int robots : kRobots) {
      const double value = Figure(results, load, robots, quantity.counter);
      if (value > 0) curve.points.emplace_back(robots, value);
    }
    curves.push_back(std::move(curve));
  }
  return PlotSvg(quantity.title, "robots", quantity.unit, curves);
}

}  // namespace

GrowthReport ReportGrowth(const Results& results) {
  std::string rows;
  for (const int robots : kRobots) {
    for (const Load& load : kLoads) rows += TableRow(results, load, robots);
  }
  if (rows.empty()) return {};
  GrowthReport report;
  report.text = absl::StrCat(
      "\n## Growth\n\nRobots at 10 observations a second each, on one server: an echo, recording, "
      "and localising on 10\njourneys of 2,000 steps, begun one after the other within 1 s. "
      "The load client shares the\nprocessors.\n\n| robots | load | answered a second | p99, ms | "
      "processor us an observation | server, MiB | dropped |\n|---|---|---|---|---|---|---|\n",
      rows);
  for (const Quantity& quantity : kQuantities) {
    const std::string picture = Plot(results, quantity);
    if (picture.empty()) continue;
    absl::StrAppend(&report.text, "\n![", quantity.title, "](images/", quantity.picture, ")\n");
    report.pictures.emplace_back(quantity.picture, picture);
  }
  return report;
}

}  // namespace homing::benchmarks
