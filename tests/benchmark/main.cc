// Measures everything, interleaved; prints a line a bound; writes the report. Run by run.sh.
// usage: homing_benchmark [--quick] [--report FILE] [--load FILE] [--command TEXT] [--filter REGEX]
// or: homing_benchmark --copy-journeys DATABASE NUMBER
// or: homing_benchmark --echo [CERT KEY]    an echo for load clients, with TLS, until it is killed
// --load names a file of lines "RUN COUNTER VALUE", one a repetition, with the results of load
// clients.
#include <benchmark/benchmark.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/process/lock_checks.h"
#include "server/process/open_files.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/benchmark/report.h"
#include "tests/benchmark/results.h"
#include "tests/benchmark/rows.h"
#include "tests/benchmark/stream_server.h"

namespace homing::benchmarks {
namespace {

struct Arguments {
  bool quick = false;
  ReportOptions report;
  std::string load;
  std::string filter = "all";
};

bool Parse(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    const bool has_value = i + 1 < argc;
    if (flag == "--quick") {
      arguments.quick = true;
    } else if (flag == "--report" && has_value) {
      arguments.report.path = argv[++i];
    } else if (flag == "--command" && has_value) {
      arguments.report.command = argv[++i];
    } else if (flag == "--load" && has_value) {
      arguments.load = argv[++i];
    } else if (flag == "--filter" && has_value) {
      arguments.filter = argv[++i];
    } else {
      std::fprintf(stderr, "homing_benchmark: %s is unknown or has no value\n", argv[i]);
      return false;
    }
  }
  return true;
}

// Interleaved: values that are compared are measured in the same minutes.
void InitializeBenchmark(const Arguments& arguments) {
  std::vector<std::string> words = {
      "homing_benchmark", "--benchmark_enable_random_interleaving=true",
      absl::StrCat("--benchmark_repetitions=", arguments.quick ? 5 : 7),
      // Of all repetitions together.
      absl::StrCat("--benchmark_min_time=", arguments.quick ? 1 : 3),
      absl::StrCat("--benchmark_filter=", arguments.filter)};
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
}

void ReadLoad(const std::string& path, Results& results) {
  std::ifstream file(path);
  std::string run;
  std::string counter;
  for (double value = 0; file >> run >> counter >> value;) {
    results.At(run).counters[counter].push_back(value);
  }
}

// Copies the one journey of a database until there are `journeys`, with all its rows.
bool CopyJourneys(const std::string& path, int journeys) {
  sqlite3* database = nullptr;
  bool ok = sqlite3_open(path.c_str(), &database) == SQLITE_OK;
  const std::string numbers = absl::StrCat(
      "WITH RECURSIVE n(i) AS (SELECT 2 UNION ALL SELECT i + 1 FROM n WHERE i < ", journeys, ") ");
  // Of steps, and of journeys, but for the keys.
  std::string step = "sequence, left_profile, right_profile";
  for (const char* place : {"left1", "left2", "right1", "right2"}) {
    for (const char* value : {"landmark", "x", "y", "count", "spread"}) {
      absl::StrAppend(&step, ", ", place, "_", value);
    }
  }
  const std::string journey =
      "state, writer_id, readers, input, next_sequence, resend_from, create_time_ns, "
      "start_time_ns, end_time_ns, step_count, landmark_count, fingerprint_count";
  const std::vector<std::string> statements = {
      "PRAGMA journal_mode=WAL",
      "PRAGMA synchronous=OFF",
      "BEGIN",
      absl::StrCat("INSERT INTO journeys (journey_id, name, ", journey, ") ", numbers,
                   "SELECT i, 'robots/r' || i || '/journeys/copy', ", journey,
                   " FROM journeys, n WHERE journey_id = 1"),
      absl::StrCat("INSERT INTO journey_settings ", numbers,
                   "SELECT i, settings FROM journey_settings, n WHERE journey_id = 1"),
      absl::StrCat("INSERT INTO steps (step_id, ", step, ") ", numbers,
                   "SELECT step_id + ((i - 1) << 25), ", step,
                   " FROM n, steps WHERE journey_id = 1"),
      "COMMIT"};
  for (const std::string& sql : statements) {
    char* message = nullptr;
    ok = ok && sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message) == SQLITE_OK;
    if (message != nullptr) std::fprintf(stderr, "homing_benchmark: %s\n", message);
    sqlite3_free(message);
  }
  sqlite3_close(database);
  return ok;
}

int Echo(const EchoTls& tls) {
  RaiseOpenFileLimit();
  const std::unique_ptr<StreamServer> server = StartEchoServer(tls);
  if (server == nullptr) return 1;
  std::printf("listening on %s\n", server->address().c_str());
  std::fflush(stdout);
  ::pause();
  return 0;
}

int Run(const Arguments& arguments) {
  RegisterIndexBenchmarks(arguments.quick);
  RegisterFrameBenchmarks(arguments.quick);
  RegisterStreamBenchmarks(arguments.quick);
  RegisterAppendBenchmarks(arguments.quick);
  RegisterLocalizeBenchmarks(arguments.quick);
  InitializeBenchmark(arguments);
  Results results;
  KeepingReporter reporter(&results);
  benchmark::RunSpecifiedBenchmarks(&reporter);
  ReadLoad(arguments.load, results);
  const std::vector<Row> rows = AllRows(results);
  bool is_short = false;
  for (const Row& row : rows) {
    is_short = is_short || row.verdict == Verdict::kShort;
    std::printf("%s %.4g %g %s\n", row.name.c_str(), row.value, row.bound, Word(row.verdict));
  }
  if (!WriteReport(arguments.report, results, rows)) {
    std::fprintf(stderr, "homing_benchmark: cannot write %s\n", arguments.report.path.c_str());
    return 2;
  }
  return is_short ? 1 : 0;
}

}  // namespace
}  // namespace homing::benchmarks

int main(int argc, char** argv) {
  homing::SkipLockChecks();
  if ((argc == 2 || argc == 4) && std::string(argv[1]) == "--echo") {
    return homing::benchmarks::Echo(argc == 4 ? homing::benchmarks::EchoTls{argv[2], argv[3]}
                                              : homing::benchmarks::EchoTls{});
  }
  if (argc == 4 && std::string(argv[1]) == "--copy-journeys") {
    return homing::benchmarks::CopyJourneys(argv[2], std::atoi(argv[3])) ? 0 : 1;
  }
  homing::benchmarks::Arguments arguments;
  if (!homing::benchmarks::Parse(argc, argv, arguments)) return 2;
  return homing::benchmarks::Run(arguments);
}
