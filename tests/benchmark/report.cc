#include "tests/benchmark/report.h"

#include <grpcpp/grpcpp.h>
#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/benchmark/growth_report.h"
#include "tests/benchmark/plot.h"

namespace homing::benchmarks {
namespace {

constexpr int kDecades = 5;

std::string SizeOf(int decade) {
  return std::to_string(static_cast<std::int64_t>(std::pow(10, 3 + decade)));
}

std::string ProcessorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string Machine() {
  return absl::StrCat(ProcessorName(), ", ", std::thread::hardware_concurrency(),
                      " cores; g++ " __VERSION__ ", gRPC ", grpc::Version(), ", OpenCV ",
                      CV_VERSION, ", SQLite ", sqlite3_libversion(), ", FAISS as in Debian 12");
}

std::string RowTable(const std::vector<Row>& rows) {
  std::string text =
      "| row | measured | 95 % interval | bound | | what |\n|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    absl::StrAppendFormat(&text, "| %s | %.3g | %.3g to %.3g | %s %g | %s | %s |\n", row.name,
                          row.value, row.low, row.high, row.at_least ? "at least" : "at most",
                          row.bound, Word(row.verdict), row.meaning);
  }
  return text;
}

// The results of load clients, also of an echo: the limit of the machine when nothing is computed
// or stored.
std::string LoadTable(const Results& results) {
  std::string rows;
  for (const std::string run : {"echo_1000", "record_1000", "echo_1000_tls", "record_1000_tls",
                                "echo_1000_ramp", "localize_1000", "localize_1000_at_once"}) {
    const auto& counters = results.Of(run).counters;
    if (counters.empty()) continue;
    absl::StrAppend(&rows, "| ", run);
    for (const char* counter : {"p99_ms", "cpu_us", "kib_a_stream", "first_answer_ms",
                                "settled_p99_ms", "late", "dropped"}) {
      absl::StrAppendFormat(&rows, " | %.5g", MedianOf(counters.at(counter)));
    }
    absl::StrAppend(&rows, " |\n");
  }
  if (rows.empty()) return "";
  return absl::StrCat(
      "\n## Many robots\n\n1,000 robots at 10 observations a second, each on its own connection; "
      "connections and TLS handshakes\nare made before. The echoes have the same reactor, threads, "
      "pool and transport and run in turns with\nthe loads. Localising robots begin one after the "
      "other within 20 s, and those of `at_once` in one\ninstant.\n\n| load | p99, ms | "
      "processor us an observation | KiB a stream | last first answer, ms | p99 after 10 s, ms | "
      "sent late | dropped |\n|---|---|---|---|---|---|---|---|\n",
      rows);
}

std::string SizeTable(const Results& results) {
  std::string text =
      "| fingerprints | layout | index, us | visited | bytes each | FAISS, us "
      "|\n|---|---|---|---|---|---|\n";
  for (const std::string layout : {"uniform", "city"}) {
    for (int decade = 0; decade < kDecades; ++decade) {
      const Series& ours = results.Of("index_" + layout + "/" + SizeOf(decade));
      const Series& peer = results.Of("faiss_" + layout + "/" + SizeOf(decade));
      if (ours.cpu_s.empty() || peer.cpu_s.empty()) continue;
      absl::StrAppendFormat(&text, "| %s | %s | %.1f | %.0f | %.1f | %.0f |\n", SizeOf(decade),
                            layout, 1e6 * MedianOf(ours.cpu_s),
                            MedianOf(ours.counters.at("visited")),
                            MedianOf(ours.counters.at("bytes")), 1e6 * MedianOf(peer.cpu_s));
    }
  }
  return text;
}

// Of the times of all sizes, or of a counter of each.
Curve CurveOf(const Results& results, const std::string& name, const std::string& color,
              const std::string& counter) {
  Curve curve{absl::StrCat(name), color, {}};
  for (int decade = 0; decade < kDecades; ++decade) {
    const Series& series = results.Of(name + "/" + SizeOf(decade));
    if (series.cpu_s.empty()) continue;
    const double value =
        counter.empty() ? 1e6 * MedianOf(series.cpu_s) : MedianOf(series.counters.at(counter));
    if (value > 0) curve.points.emplace_back(std::pow(10, 3 + decade), value);
  }
  return curve;
}

bool Write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  return file.good();
}

}  // namespace

bool WriteReport(const ReportOptions& options, const Results& results,
                 const std::vector<Row>& rows) {
  if (options.path.empty()) return true;
  const std::string time_plot =
      PlotSvg("Time of one query by number of fingerprints", "fingerprints", "microseconds",
              {CurveOf(results, "index_uniform", "#1f77b4", ""),
               CurveOf(results, "index_city", "#2ca02c", ""),
               CurveOf(results, "faiss_uniform", "#d62728", "")});
  const std::string byte_plot =
      PlotSvg("Memory by number of fingerprints", "fingerprints", "bytes a fingerprint",
              {CurveOf(results, "index_uniform", "#1f77b4", "bytes"),
               CurveOf(results, "index_city", "#2ca02c", "bytes")});
  const std::filesystem::path path(options.path);
  const auto images = path.parent_path() / "images";
  const GrowthReport growth = ReportGrowth(results);
  std::string text =
      absl::StrCat("# Performance\n\nWritten by `", options.command,
                   "`. A row is `short` only if its 95 % bootstrap"
                   " interval over interleaved\nrepeats lies wholly on the wrong "
                   "side of its bound, `unsure` if it"
                   " straddles it. What has no row here has not been "
                   "measured.\nRows of one thread compare the time"
                   " of that thread, rows of many the wall's.\n\nMachine: ",
                   Machine(), ".\n\n## Rows\n\n", RowTable(rows), LoadTable(results), growth.text);
  if (!time_plot.empty()) {
    absl::StrAppend(&text, "\n## The index of all journeys by size\n\n", SizeTable(results),
                    "\n![Time of one query](images/index_time.svg)\n\n"
                    "![Memory](images/index_bytes.svg)\n");
  }
  for (const auto& [name, picture] : growth.pictures) {
    if (!Write(images / name, picture)) return false;
  }
  return Write(path, text) && (time_plot.empty() || (Write(images / "index_time.svg", time_plot) &&
                                                     Write(images / "index_bytes.svg", byte_plot)));
}

}  // namespace homing::benchmarks
