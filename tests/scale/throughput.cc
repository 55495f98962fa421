// Durable observations a second: SQLite, servers on PostgreSQL, and PostgreSQL by itself.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "nlohmann/json.hpp"
#include "storage/journey_store.h"
#include "tests/integration/program.h"
#include "tests/scale/checks.h"
#include "tests/scale/shared_database.h"
#include "tests/support/route.h"

namespace homing::scale {
namespace {

using Clock = std::chrono::steady_clock;

// More than two processors can serve, so that the figure is the server's.
constexpr int kRobots = 300;
constexpr int kRate = 100;
constexpr int kBatch = 1024;

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

// The answers a second of one load on each of the servers; 0: a load failed.
double LoadAll(const Programs& programs, const std::vector<std::string>& addresses, int seconds,
               const std::string& prefix) {
  std::vector<std::unique_ptr<Program>> loads;
  const int robots = kRobots / static_cast<int>(addresses.size());
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    loads.push_back(std::make_unique<Program>(std::vector<std::string>{
        programs.bench, "--server", addresses[i], "--json", "--quiet", "--robots",
        absl::StrCat(robots), "--rate", absl::StrCat(kRate), "--seconds", absl::StrCat(seconds),
        "--prefix", absl::StrCat(prefix, "-", i)}));
  }
  double sum = 0;
  for (const auto& load : loads) {
    const auto line = load->ReadLine();
    const int code = load->Wait();
    if (!line || code != 0) {
      std::cerr << "load: exit code " << code << ' ' << load->Stderr() << '\n';
      return 0;
    }
    sum += nlohmann::json::parse(*line).value("per_second", 0.0);
  }
  return sum;
}

double OnSqlite(const Programs& programs, int seconds, const std::string& prefix) {
  const TemporaryFolder folder;
  faults::ServerUnderTest server(programs.server, folder.File(""));
  if (!server.Start()) return 0;
  const double figure = LoadAll(programs, {server.address()}, seconds, prefix);
  server.Stop();
  return figure;
}

double OnPostgres(const Programs& programs, SharedDatabase* database, int servers, int seconds,
                  const std::string& prefix) {
  if (!database->StartServers(servers)) return 0;
  std::vector<std::string> addresses;
  for (int i = 0; i < servers; ++i) {
    addresses.push_back(database->server(static_cast<std::size_t>(i)).address());
  }
  const double figure = LoadAll(programs, addresses, seconds, prefix);
  database->StopServers();
  return figure;
}

// The same rows without servers and robots, one after the other in large batches.
double StoreAlone(const std::string& url, int seconds) {
  storage::StoreOptions options;
  options.url = url;
  const auto store = storage::OpenJourneyStore(options);
  if (!store.ok()) return 0;
  std::vector<storage::JourneyAppend> batch(kBatch);
  for (int i = 0; i < kBatch; ++i) {
    storage::JourneyRecord record;
    record.name = absl::StrCat("robots/alone/journeys/", i);
    storage::JourneyAppend& append = batch[static_cast<std::size_t>(i)];
    append.journey = record.name;
    append.input = InputKind::kFlowVectors;
    const bool is_created = (*store)->CreateJourney(record).ok();
    const auto acquired = (*store)->AcquireJourney(record.name, "alone");
    if (!is_created || !acquired.ok()) return 0;
    append.epoch = acquired->epoch;
  }
  const FlowProfile profile = MakeFlowProfile(test::FieldAt(1, Side::kLeft));
  const auto begin = Clock::now();
  std::int64_t rows = 0;
  while (Clock::now() - begin < std::chrono::seconds(seconds)) {
    for (storage::JourneyAppend& append : batch) {
      JourneyStep step;
      step.step = append.sequence;
      step.sequence = append.sequence;
      step.profiles = {profile, profile};
      append.step = step;
    }
    for (const absl::Status& status : (*store)->AppendSteps(batch)) rows += status.ok();
    for (storage::JourneyAppend& append : batch) ++append.sequence;
  }
  return static_cast<double>(rows) / std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

void CheckThroughput(const Programs& programs, int seconds, faults::Figures* figures) {
  SharedDatabase database(programs.server, programs.database);
  if (!database.Start()) return figures->Failed("scale_throughput", "no database");
  // In turns, because the machine's load changes.
  constexpr int kTurns = 3;
  std::vector<double> sqlite;
  std::vector<std::vector<double>> postgres(3);
  std::vector<double> ratios;
  for (int turn = 0; turn < kTurns; ++turn) {
    sqlite.push_back(OnSqlite(programs, seconds, absl::StrCat("sqlite", turn)));
    for (int servers = 1; servers <= 3; ++servers) {
      postgres[static_cast<std::size_t>(servers - 1)].push_back(OnPostgres(
          programs, &database, servers, seconds, absl::StrCat("servers", servers, "-", turn)));
    }
    ratios.push_back(sqlite.back() == 0 ? 0 : postgres[0].back() / sqlite.back());
  }
  figures->AtLeast("scale_sqlite_per_s", Median(sqlite), 1);
  figures->AtLeast("scale_postgres_1_server_per_s", Median(postgres[0]), 1);
  figures->AtLeast("scale_postgres_2_servers_per_s", Median(postgres[1]), 1);
  figures->AtLeast("scale_postgres_3_servers_per_s", Median(postgres[2]), 1);
  figures->AtLeast("scale_postgres_to_sqlite", Median(ratios), 0.6);
  figures->AtLeast("scale_postgres_alone_per_s", StoreAlone(database.url(), seconds), 1);
}

}  // namespace homing::scale
