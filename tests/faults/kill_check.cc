// The server dies at random moments of recording.
#include <fstream>
#include <random>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "tests/faults/checks.h"
#include "tests/faults/fleet.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

constexpr int kRobots = 8;
constexpr int kLongestWaitMs = 150;

class Killer {
 public:
  Killer(const Programs& programs, bool power, std::uint64_t seed)
      : programs_(programs),
        power_(power),
        random_(seed),
        server_(programs.server, folder_.File("data")) {
    WriteFiles(server_.folder(), {});
  }

  bool Start() {
    if (!power_) return server_.Start();
    before_ = ReadFiles(server_.folder());
    std::filesystem::remove(log_);
    return server_.Start({"LD_PRELOAD=" + programs_.faulty_disk,
                          "FAULTY_DISK_DIR=" + server_.folder(), "FAULTY_DISK_LOG=" + log_,
                          "FAULTY_DISK_SYNC_MS=5"});
  }

  // Kills the server and compares its database with the acknowledged observations.
  absl::Status Kill(const Ledger& ledger) {
    server_.Kill();
    if (power_) Forget();
    // Answers that the server sent before it died still arrive; no others can.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const std::string copy = folder_.File("copy");
    WriteFiles(copy, ReadFiles(server_.folder()));
    const auto check = CheckDatabase("sqlite:" + copy + "/homing.db", ledger.entries());
    if (!check.ok()) return check.status();
    total_.lost += check->lost;
    total_.twice += check->twice;
    return absl::OkStatus();
  }

  void WaitRandomly() {
    std::uniform_int_distribution<int> wait(0, kLongestWaitMs);
    std::this_thread::sleep_for(std::chrono::milliseconds(wait(random_)));
  }

  ServerUnderTest& server() { return server_; }
  const LedgerCheck& total() const { return total_; }
  int forgotten() const { return forgotten_; }

 private:
  void Forget() {
    const std::ifstream file(log_, std::ios::binary);
    std::ostringstream log;
    log << file.rdbuf();
    const PowerCut cut = CutPower(before_, log.str(), random_());
    forgotten_ += cut.lost;
    WriteFiles(server_.folder(), cut.files);
  }

  const Programs programs_;
  const bool power_;
  std::mt19937_64 random_;
  const TemporaryFolder folder_;
  const std::string log_ = folder_.File("log");
  ServerUnderTest server_;
  std::map<std::string, std::string> before_;
  LedgerCheck total_;
  int forgotten_ = 0;
};

absl::Status KillWhileRecording(int kills, const Ledger& ledger, const Fleet& fleet,
                                Killer* killer) {
  for (int i = 0; i < kills; ++i) {
    if (!fleet.AwaitProgress()) return absl::UnavailableError("no progress; " + fleet.error());
    killer->WaitRandomly();
    if (absl::Status status = killer->Kill(ledger); !status.ok()) return status;
    if (!killer->Start()) return absl::UnavailableError("the server does not start again");
  }
  return absl::OkStatus();
}

}  // namespace

void CheckKills(const Programs& programs, int kills, bool power, std::uint64_t seed,
                Figures* figures) {
  const std::string name = power ? "power_cut" : "kill";
  RobotOptions robot;
  Killer killer(programs, power, seed);
  std::map<int, std::string> maps;
  {
    const TemporaryFolder folder;
    ServerUnderTest calm(programs.server, folder.File(""));
    if (!calm.Start()) return figures->Failed(name, "no server");
    maps = UndisturbedMaps(calm.address(), robot, kRobots);
    calm.Stop();
  }
  if (!killer.Start()) return figures->Failed(name, "no server");
  robot.address = killer.server().address();
  Ledger ledger;
  Fleet fleet(robot, kRobots, &ledger);
  const absl::Status status = KillWhileRecording(kills, ledger, fleet, &killer);
  if (!status.ok()) figures->Failed(name, status.ToString());
  fleet.Finish();
  if (!fleet.error().empty()) figures->Failed(name, fleet.error());
  const auto entries = ledger.entries();
  figures->AtLeast(name + "_times", kills, kills);
  if (power) figures->AtLeast(name + "_writes_forgotten", killer.forgotten(), 1);
  figures->AtLeast(name + "_observations_acknowledged", static_cast<double>(TotalOf(entries)),
                   kills);
  figures->AtMost(name + "_acknowledged_lost", static_cast<double>(killer.total().lost), 0);
  figures->AtMost(name + "_stored_twice", static_cast<double>(killer.total().twice), 0);
  figures->AtLeast(name + "_maps_compared", static_cast<double>(entries.size()), kRobots);
  figures->AtMost(name + "_maps_unlike", CountUnlike(killer.server().address(), entries, maps), 0);
  figures->AtMost(name + "_exit_code", killer.server().Stop(), 0);
}

}  // namespace homing::faults
