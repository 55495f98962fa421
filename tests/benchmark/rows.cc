#include "tests/benchmark/rows.h"

#include <algorithm>
#include <random>

namespace homing::benchmarks {
namespace {

constexpr int kResamples = 4000;

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Verdict VerdictOf(const Row& row) {
  const double worst = row.at_least ? row.low : -row.high;
  const double best = row.at_least ? row.high : -row.low;
  const double bound = row.at_least ? row.bound : -row.bound;
  if (worst >= bound) return Verdict::kOk;
  return best < bound ? Verdict::kShort : Verdict::kUnsure;
}

class Table {
 public:
  explicit Table(const Results& results) : results_(results) {}

  void Add(const Row& row, const std::vector<double>& values) {
    if (!values.empty()) rows_.push_back(Judge(row, values));
  }
  // How many times faster `ours` is than `peer`, by the time of one thread or by the wall's.
  void Faster(const std::string& name, const std::string& peer, const std::string& ours,
              double bound, bool by_wall, const std::string& meaning) {
    const Series& a = results_.Of(peer);
    const Series& b = results_.Of(ours);
    Add({.name = name, .meaning = meaning, .bound = bound},
        by_wall ? Quotients(a.wall_s, b.wall_s) : Quotients(a.cpu_s, b.cpu_s));
  }
  void AtMost(const std::string& name, const std::vector<double>& values, double bound,
              const std::string& meaning) {
    Add({.name = name, .meaning = meaning, .bound = bound, .at_least = false}, values);
  }
  const std::vector<double>& Counter(const std::string& series, const std::string& name) {
    static const std::vector<double>* const none = new std::vector<double>;
    const auto& counters = results_.Of(series).counters;
    const auto found = counters.find(name);
    return found == counters.end() ? *none : found->second;
  }
  std::vector<Row> Take() { return std::move(rows_); }

 private:
  const Results& results_;
  std::vector<Row> rows_;
};

void AddIndexRows(const Results& results, Table& table) {
  for (const std::string layout : {"uniform", "city"}) {
    const std::string ours = "index_" + layout + "/";
    const std::string peer = "faiss_" + layout + "/";
    table.Faster("index_" + layout + "_1e6", peer + "1000000", ours + "1000000", 150, false,
                 "exact top 10 of 10^6 fingerprints against FAISS IndexFlatL2");
    table.Faster("index_" + layout + "_1e7", peer + "10000000", ours + "10000000", 800, false,
                 "exact top 10 of 10^7 fingerprints against FAISS IndexFlatL2");
    table.AtMost("index_" + layout + "_unlike_scan", table.Counter(ours + "1000000", "unlike"), 0,
                 "queries answered otherwise than by the scan, of those compared");
    table.AtMost("index_" + layout + "_visited_growth",
                 Quotients(table.Counter(ours + "10000000", "visited"),
                           table.Counter(ours + "10000", "visited")),
                 7.0 / 4.0, "fingerprints visited, 10^7 over 10^4; log N grows by 1.75");
    table.AtMost("index_" + layout + "_time_growth",
                 Quotients(results.Of(ours + "10000000").cpu_s, results.Of(ours + "10000").cpu_s),
                 4, "time of a query, 10^7 over 10^4");
    for (const std::string size : {"1000000", "10000000"}) {
      table.AtMost("index_" + layout + "_build_s_per_million_" + size,
                   table.Counter("index_build_" + layout + "/" + size, "s_per_million"), 0.6,
                   "seconds a million fingerprints");
      table.AtMost("index_" + layout + "_bytes_" + size, table.Counter(ours + size, "bytes"), 32,
                   "bytes a fingerprint, with everything");
    }
  }
  table.AtMost("index_appended_bytes", table.Counter("index_append/1000000", "bytes"), 32,
               "bytes a fingerprint when each was appended alone");
  table.AtMost("index_longest_append_ms", table.Counter("index_append/1000000", "longest_ms"), 1,
               "longest time of one append, ms of its thread");
}

// A load against an echo on the same reactor, threads, pool and transport, in turns.
struct LoadBounds {
  std::string run;
  std::string echo;
  double p99 = 0;
  double cpu = 0;
  // KiB over the echo's; 0: not judged.
  double kib = 0;
};

void AddLoadRow(const LoadBounds& load, Table& table) {
  const auto& over_echo = [&](const std::string& counter, double bound,
                              const std::string& meaning) {
    table.AtMost(load.run + "_" + counter + "_to_echo",
                 Quotients(table.Counter(load.run, counter), table.Counter(load.echo, counter)),
                 bound, meaning);
  };
  over_echo("p99_ms", load.p99, "99th percentile from due to answered, times the echo's");
  over_echo("cpu_us", load.cpu, "server's processor time an observation, times the echo's");
  if (load.kib > 0) {
    table.AtMost(load.run + "_kib_over_echo",
                 Differences(table.Counter(load.run, "kib_a_stream"),
                             table.Counter(load.echo, "kib_a_stream")),
                 load.kib, "server's memory a stream, KiB more than the echo's");
  }
  table.AtMost(load.run + "_dropped", table.Counter(load.run, "dropped"), 0,
               "observations not answered");
}

void AddLoadRows(Table& table) {
  AddLoadRow({"record_1000", "echo_1000", 3, 2.2, 24}, table);
  AddLoadRow({"record_1000_tls", "echo_1000_tls", 3, 2.2, 24}, table);
  AddLoadRow({"localize_1000", "echo_1000_ramp", 4, 2.5, 128}, table);
  const std::string at_once = "localize_1000_at_once";
  table.AtMost(at_once + "_first_answer_ms", table.Counter(at_once, "first_answer_ms"), 2000,
               "all begin in one instant: the last robot's first answer");
  table.AtMost(at_once + "_settled_p99_ms", table.Counter(at_once, "settled_p99_ms"), 100,
               "all begin in one instant: 99th percentile of observations scheduled 10 s after the "
               "first and later");
  table.AtMost(at_once + "_dropped", table.Counter(at_once, "dropped"), 0,
               "observations not answered");
}

}  // namespace

const char* Word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kShort:
      return "short";
    case Verdict::kUnsure:
      break;
  }
  return "unsure";
}

std::vector<double> Quotients(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> quotients;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    quotients.push_back(a[i] / b[i]);
  }
  return quotients;
}

std::vector<double> Differences(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    differences.push_back(a[i] - b[i]);
  }
  return differences;
}

Row Judge(Row row, const std::vector<double>& values) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> draw(0, values.size() - 1);
  std::vector<double> medians;
  std::vector<double> resample(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : resample) value = values[draw(random)];
    medians.push_back(Median(resample));
  }
  std::sort(medians.begin(), medians.end());
  row.value = Median(values);
  row.low = medians[kResamples / 40];
  row.high = medians[kResamples - 1 - kResamples / 40];
  row.repeats = static_cast<int>(values.size());
  row.verdict = VerdictOf(row);
  return row;
}

std::vector<Row> AllRows(const Results& results) {
  Table table(results);
  AddIndexRows(results, table);
  for (const std::string size : {"640x480", "320x240"}) {
    table.Faster("frames_" + size, "opencv_" + size, "frames_" + size, 1.0, false,
                 "frames to fingerprints against the bare OpenCV calls in a loop");
  }
  const auto& over_grpc = [&](const std::string& name, double bound, const std::string& meaning) {
    table.Add({.name = name, .meaning = meaning, .bound = bound},
              Quotients(table.Counter(name, "peer_s"), table.Counter(name, "ours_s")));
  };
  over_grpc("frames_grpc", 0.85,
            "frames over gRPC to durable fingerprints against the same without a network");
  over_grpc("flow_grpc", 0.5,
            "flow vectors to durable fingerprints against an echo on the same server");
  table.Faster("append_durable", "append_plain", "append_durable", 0.7, true,
               "durable appends against plain SQLite, same batch and pragmas");
  const auto& localize = [&](const std::string& name, const std::string& series, double bound,
                             const std::string& meaning) {
    std::vector<double> microseconds = results.Of(series).cpu_s;
    for (double& value : microseconds) value *= 1e6;
    table.AtMost(name, microseconds, bound, meaning);
  };
  localize("localize_steady", "localize_steady", 40,
           "us of one core, two cameras, the place known, 2,000 steps");
  localize("localize_full_2000", "localize_full/2000", 150,
           "us of one core, two cameras, all of 2,000 steps compared");
  localize("localize_full_10000", "localize_full/10000", 500,
           "us of one core, two cameras, all of 10,000 steps compared");
  AddLoadRows(table);
  table.AtMost("start_serving_s", table.Counter("start", "serving_s"), 0.5,
               "start to SERVING with 10,000 journeys of 1,000 steps");
  return table.Take();
}

}  // namespace homing::benchmarks
