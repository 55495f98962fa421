// Robots on three servers, through everything that happens to servers and database.
#include <signal.h>

#include <atomic>
#include <functional>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "storage/journey_store.h"
#include "tests/faults/fleet.h"
#include "tests/scale/checks.h"
#include "tests/scale/gap_watch.h"
#include "tests/scale/shared_database.h"

namespace homing::scale {
namespace {

using faults::RobotOptions;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kRobots = 50;
constexpr int kServers = 3;
// Journeys to localise on.
constexpr int kHomeJourneys = 5;
constexpr seconds kPause{20};
// After each event, for robots to show the gap.
constexpr seconds kCalm{4};

RobotOptions Robots(const std::string& address) {
  RobotOptions options;
  options.address = address;
  options.frames_every = 5;
  options.observations = 60;
  options.pace = milliseconds(100);
  return options;
}

// Robots that localise on the finished journeys until stopped.
class Localizers {
 public:
  Localizers(const RobotOptions& options, GapWatch* gaps) {
    for (int i = 0; i < kRobots; ++i) {
      RobotOptions own = options;
      own.robot = i % kHomeJourneys;
      own.on_answer = [this, gaps, i](auto) {
        ++answers_;
        gaps->Answered(1000 + i);
      };
      own.log = [gaps, i](const std::string& step) { gaps->Noted(1000 + i, step); };
      threads_.emplace_back([this, own] {
        while (!stopping_) {
          const auto share = faults::LocalizeOn(own, faults::JourneyOf(own.robot, 0));
          if (!share.ok()) {
            std::cerr << "localising: " << share.status() << '\n';
            ++failed_;
            return;
          }
        }
      });
    }
  }
  ~Localizers() { Finish(); }
  void Finish() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  int failed() const { return failed_; }
  std::int64_t answers() const { return answers_; }

 private:
  std::atomic<bool> stopping_ = false;
  std::atomic<int> failed_ = 0;
  std::atomic<std::int64_t> answers_ = 0;
  std::vector<std::thread> threads_;
};

bool FailOver(const std::string& event, SharedDatabase* database, GapWatch* gaps) {
  gaps->SetEvent(event);
  const bool is_promoted = database->FailOver();
  std::this_thread::sleep_for(kCalm);
  gaps->SetEvent("replica_added");
  const bool has_replica = is_promoted && database->AddReplica();
  std::this_thread::sleep_for(kCalm);
  gaps->SetEvent("");
  return has_replica;
}

// One of each event. False: a server or the database did not come back.
bool RunRound(int round, SharedDatabase* database, GapWatch* gaps) {
  faults::ServerUnderTest& killed = database->server(static_cast<std::size_t>(round % kServers));
  gaps->SetEvent("server_killed");
  killed.Kill();
  std::this_thread::sleep_for(kCalm);
  if (!killed.Start()) return false;
  std::this_thread::sleep_for(kCalm);

  const faults::ServerUnderTest& paused =
      database->server(static_cast<std::size_t>((round + 1) % kServers));
  gaps->SetEvent("server_paused");
  paused.Signal(SIGSTOP);
  std::this_thread::sleep_for(kPause);
  paused.Signal(SIGCONT);
  std::this_thread::sleep_for(kCalm);

  return FailOver("database_promoted", database, gaps);
}

bool KillLeader(int /*round*/, SharedDatabase* database, GapWatch* gaps) {
  return FailOver("leader_killed", database, gaps);
}

// One kind of check: its events, and what it may cost.
struct Check {
  // Begins each line.
  std::string name;
  std::function<bool(int round, SharedDatabase* database, GapWatch* gaps)> run_round;
  // Seconds at most, by event.
  std::vector<std::pair<const char*, double>> gaps;
};

void CompareWithUndisturbed(const std::string& name, const std::string& server,
                            const std::string& address, const faults::Ledger& ledger,
                            faults::Figures* figures) {
  const TemporaryFolder folder;
  faults::ServerUnderTest calm(server, folder.File(""));
  if (!calm.Start()) return figures->Failed(name + "_maps_unlike", "no server");
  const auto maps = faults::UndisturbedMaps(calm.address(), Robots(""), kRobots);
  calm.Stop();
  const auto entries = ledger.entries();
  figures->AtLeast(name + "_maps_compared", static_cast<double>(entries.size()), kRobots);
  figures->AtMost(name + "_maps_unlike", faults::CountUnlike(address, entries, maps), 0);
}

void CompareWithLedger(const std::string& name, const std::string& url,
                       const faults::Ledger& ledger, faults::Figures* figures) {
  const auto entries = ledger.entries();
  const auto check = faults::CheckDatabase(url, entries);
  if (!check.ok()) return figures->Failed(name + "_acknowledged_lost", check.status().ToString());
  figures->AtLeast(name + "_acknowledged", static_cast<double>(faults::TotalOf(entries)), 1);
  figures->AtMost(name + "_acknowledged_lost", static_cast<double>(check->lost), 0);
  // Also what a server wrote that had lost the journey to another.
  figures->AtMost(name + "_stored_twice", static_cast<double>(check->twice), 0);
}

void CheckFleet(const Check& check, const std::string& server, const std::string& script,
                int rounds, double tolerance, faults::Figures* figures) {
  SharedDatabase database(server, script);
  if (!database.Start() || !database.StartServers(kServers)) {
    return figures->Failed(check.name + "_rounds", "the servers do not start");
  }
  RobotOptions options = Robots(database.addresses());
  faults::Ledger home;
  for (options.robot = 0; options.robot < kHomeJourneys; ++options.robot) {
    options.pace = milliseconds(0);
    const auto status = faults::RecordOne(options, faults::JourneyOf(options.robot, 0), &home);
    if (!status.ok()) return figures->Failed(check.name + "_rounds", status.ToString());
  }
  options = Robots(database.addresses());
  GapWatch gaps;
  faults::Ledger ledger;
  Localizers localizers(options, &gaps);
  faults::Fleet fleet(
      options, kRobots, &ledger, /*first_journey=*/1, [&gaps](int robot) { gaps.Answered(robot); },
      [&gaps](int robot, const std::string& step) { gaps.Noted(robot, step); });
  int done = 0;
  while (done < rounds && fleet.error().empty() && check.run_round(done, &database, &gaps)) ++done;
  fleet.Finish();
  localizers.Finish();
  if (!fleet.error().empty()) figures->Failed(check.name + "_recording", fleet.error());
  figures->AtLeast(check.name + "_rounds", done, rounds);
  figures->AtMost(check.name + "_clients_failed", localizers.failed(), 0);
  figures->AtLeast(check.name + "_localised", static_cast<double>(localizers.answers()), rounds);
  CompareWithLedger(check.name, database.url(), ledger, figures);
  CompareWithUndisturbed(check.name, server, database.addresses(), ledger, figures);
  for (const auto& [event, most] : check.gaps) {
    figures->AtMost(absl::StrCat(check.name, "_gap_", event, "_s"), gaps.LongestSeconds(event),
                    tolerance * most);
  }
}

}  // namespace

void CheckRounds(const Programs& programs, int rounds, double tolerance, faults::Figures* figures) {
  const Check check{"scale",
                    RunRound,
                    {{"server_killed", 5},
                     {"server_paused", 10},
                     {"database_promoted", 5},
                     {"replica_added", 10}}};
  CheckFleet(check, programs.server, programs.database, rounds, tolerance, figures);
}

void CheckPatroni(const Programs& programs, int rounds, double tolerance,
                  faults::Figures* figures) {
  const Check check{"patroni", KillLeader, {{"leader_killed", 30}, {"replica_added", 10}}};
  CheckFleet(check, programs.server, programs.patroni, rounds, tolerance, figures);
}

}  // namespace homing::scale
