// Durable appends against plain SQLite: the same rows in one transaction, the same pragmas.
#include <benchmark/benchmark.h>
#include <sqlite3.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/landmark/profile_code.h"
#include "storage/journey_store.h"
#include "storage/step_id.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/support/temporary_folder.h"

namespace homing::benchmarks {
namespace {

// Robots that append a step each in a round.
constexpr int kRobots = 64;

std::string NameOf(int robot) { return absl::StrCat("robots/r", robot, "/journeys/j"); }

FlowProfile ProfileOf(std::int64_t step) {
  FlowProfile profile{};
  for (std::size_t i = 0; i < profile.cells.size(); i += 3) {
    profile.cells[i] = static_cast<std::uint8_t>(17 + (i + static_cast<std::size_t>(step)) % 90);
  }
  return profile;
}

// Two fingerprints and a profile; a landmark lasts ten steps.
JourneyStep StepOf(std::int64_t step) {
  JourneyStep made;
  made.step = step;
  const auto landmark = static_cast<std::int32_t>(step / 10 * 2);
  made.fingerprints = {{Side::kLeft, {100, 200, 50, landmark}, 0.1},
                       {Side::kLeft, {400, 210, 70, landmark + 1}, 0.2}};
  made.profiles[0] = ProfileOf(step);
  return made;
}

std::unique_ptr<storage::JourneyStore> OpenStore(const std::string& path) {
  storage::StoreOptions options;
  options.url = absl::StrCat("sqlite:", path);
  auto store = storage::OpenJourneyStore(options);
  for (int robot = 0; store.ok() && robot < kRobots; ++robot) {
    storage::JourneyRecord record;
    record.name = NameOf(robot);
    record.writer_id = "w";
    if (!(*store)->CreateJourney(record).ok()) return nullptr;
  }
  return store.ok() ? std::move(*store) : nullptr;
}

void AppendDurably(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto store = OpenStore(folder.File("a.db"));
  std::int64_t step = 0;
  for (auto _ : state) {
    std::vector<storage::JourneyAppend> batch;
    for (int robot = 0; robot < kRobots; ++robot) {
      batch.push_back({NameOf(robot), step, InputKind::kFlowVectors, 1 + step, StepOf(step), {}});
    }
    for (const absl::Status& status : store->AppendSteps(batch)) {
      if (!status.ok()) state.SkipWithError(std::string(status.message()).c_str());
    }
    ++step;
  }
}

// The statements of one step, prepared once.
class PlainSqlite {
 public:
  explicit PlainSqlite(const std::string& path) {
    sqlite3_open(path.c_str(), &database_);
    Execute("PRAGMA journal_mode=WAL");
    Execute("PRAGMA synchronous=FULL");
    Execute("PRAGMA journal_size_limit=67108864");
    Execute("PRAGMA wal_autocheckpoint=12288");
    Execute("PRAGMA cache_size=-6144");
    Execute("PRAGMA foreign_keys=ON");
    step_ = Prepare(
        "INSERT INTO steps (step_id, left1_landmark, left1_x, left1_y, left1_count, left1_spread,"
        " left2_landmark, left2_x, left2_y, left2_count, left2_spread, left_profile)"
        " VALUES (?,?,?,?,?,?,?,?,?,?,?,?)");
    journey_ = Prepare(
        "UPDATE journeys SET next_sequence = ?2, input = 'FLOW_VECTORS',"
        " end_time_ns = ?3, step_count = ?4, landmark_count = ?5,"
        " fingerprint_count = fingerprint_count + 2 WHERE journey_id = ?1");
  }
  ~PlainSqlite() {
    for (sqlite3_stmt* statement : {step_, journey_}) sqlite3_finalize(statement);
    sqlite3_close(database_);
  }
  PlainSqlite(const PlainSqlite&) = delete;
  PlainSqlite& operator=(const PlainSqlite&) = delete;

  void Execute(const char* sql) {
    ok_ = sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) == SQLITE_OK && ok_;
  }
  void Append(std::int64_t journey, const JourneyStep& step) {
    sqlite3_bind_int64(step_, 1, storage::StepId(journey, step.step));
    int index = 1;
    for (const RecordedFingerprint& recorded : step.fingerprints) {
      const Fingerprint& f = recorded.fingerprint;
      sqlite3_bind_int64(step_, ++index, f.landmark);
      sqlite3_bind_double(step_, ++index, f.x);
      sqlite3_bind_double(step_, ++index, f.y);
      sqlite3_bind_int64(step_, ++index, f.count);
      sqlite3_bind_double(step_, ++index, recorded.spread);
    }
    const std::string cells = EncodeProfile(*step.profiles[0]);
    sqlite3_bind_blob(step_, ++index, cells.data(), static_cast<int>(cells.size()), SQLITE_STATIC);
    Run(step_);
    sqlite3_bind_int64(journey_, 1, journey);
    sqlite3_bind_int64(journey_, 2, step.step + 1);
    sqlite3_bind_int64(journey_, 3, step.step + 1);
    sqlite3_bind_int64(journey_, 4, step.step + 1);
    sqlite3_bind_int64(journey_, 5, step.fingerprints.back().fingerprint.landmark + 1);
    Run(journey_);
  }
  bool ok() const { return ok_; }

 private:
  sqlite3_stmt* Prepare(const char* sql) {
    sqlite3_stmt* statement = nullptr;
    ok_ = sqlite3_prepare_v2(database_, sql, -1, &statement, nullptr) == SQLITE_OK && ok_;
    return statement;
  }
  void Run(sqlite3_stmt* statement) {
    ok_ = sqlite3_step(statement) == SQLITE_DONE && ok_;
    sqlite3_reset(statement);
  }

  sqlite3* database_ = nullptr;
  sqlite3_stmt* step_ = nullptr;
  sqlite3_stmt* journey_ = nullptr;
  bool ok_ = true;
};

void AppendPlainly(benchmark::State& state) {
  const TemporaryFolder folder;
  const std::string path = folder.File("b.db");
  // Its schema, and then no part of it.
  OpenStore(path).reset();
  PlainSqlite plain(path);
  std::int64_t step = 0;
  for (auto _ : state) {
    plain.Execute("BEGIN IMMEDIATE");
    for (int robot = 0; robot < kRobots; ++robot) plain.Append(1 + robot, StepOf(step));
    plain.Execute("COMMIT");
    ++step;
  }
  if (!plain.ok()) state.SkipWithError("SQLite refused");
}

}  // namespace

void RegisterAppendBenchmarks(bool /*quick*/) {
  benchmark::RegisterBenchmark("append_durable", AppendDurably)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("append_plain", AppendPlainly)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace homing::benchmarks
