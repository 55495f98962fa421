// The disk fills up, fails or turns read-only in mid-stream, and comes back.
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "absl/strings/str_cat.h"
#include "tests/faults/await_health.h"
#include "tests/faults/checks.h"
#include "tests/faults/fleet.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

constexpr int kFleet = 4;
// Not of the fleet: its journey is whole before the trouble.
constexpr int kCalmRobot = kFleet;

struct Trouble {
  std::string name;
  std::function<void()> begin;
  std::function<void()> end;
  // The error of a client that does not wait.
  absl::StatusCode code = absl::StatusCode::kUnavailable;
  // A journey can be deleted meanwhile.
  bool deletes = false;
  // Robots come home meanwhile.
  bool localises = true;
};

// A server with recording robots, and the checks before, during and after a fault.
class Trial {
 public:
  Trial(const Programs& programs, std::string folder, std::string control, Figures* figures)
      : control_(std::move(control)),
        faulty_disk_(programs.faulty_disk),
        figures_(figures),
        server_(programs.server, std::move(folder)) {}

  bool Start() {
    std::vector<std::string> environment;
    if (!control_.empty()) {
      environment = {"LD_PRELOAD=" + faulty_disk_, "FAULTY_DISK_DIR=" + server_.folder(),
                     "FAULTY_DISK_CONTROL=" + control_};
    }
    if (!server_.Start(environment)) return false;
    robot_.address = server_.address();
    maps_ = UndisturbedMaps(server_.address(), robot_, kFleet);
    for (int robot = 0; robot < kFleet; ++robot) {
      if (!DeleteOne(robot_, JourneyOf(robot, 0)).ok()) return false;
    }
    calm_ = robot_;
    calm_.robot = kCalmRobot;
    calm_.pace = std::chrono::milliseconds(0);
    Ledger spare;
    return RecordOne(calm_, kSpare, &spare).ok() && RecordOne(calm_, kJourney, &ledger_).ok();
  }

  void Run(const Trouble& trouble) {
    {
      Fleet fleet(robot_, kFleet, &ledger_);
      figures_->Holds(trouble.name + "_recording_before", fleet.AwaitProgress());
      trouble.begin();
      CheckInTrouble(trouble);
      trouble.end();
      figures_->Holds(trouble.name + "_serving_after", AwaitHealth(server_.address(), true));
      figures_->Holds(trouble.name + "_recording_goes_on", fleet.AwaitProgress());
      fleet.Finish();
      if (!fleet.error().empty()) figures_->Failed(trouble.name, fleet.error());
    }
    auto entries = ledger_.entries();
    entries.erase(kJourney);
    entries.erase(kHasty);
    figures_->AtMost(trouble.name + "_maps_unlike", CountUnlike(server_.address(), entries, maps_),
                     0);
  }

  // The server stops; nothing that was acknowledged may be missing.
  void Stop(const std::string& name) {
    figures_->AtMost(name + "_exit_code", server_.Stop(), 0);
    const auto check = CheckDatabase(server_.Url(), ledger_.entries());
    if (!check.ok()) return figures_->Failed(name, check.status().ToString());
    figures_->AtMost(name + "_acknowledged_lost", static_cast<double>(check->lost), 0);
    figures_->AtMost(name + "_stored_twice", static_cast<double>(check->twice), 0);
  }

  absl::StatusOr<double> Localize() const { return LocalizeOn(calm_, kJourney); }
  const RobotOptions& robot() const { return robot_; }

 private:
  static constexpr char kJourney[] = "robots/1000/journeys/0";
  static constexpr char kHasty[] = "robots/1001/journeys/0";
  static constexpr char kSpare[] = "robots/1002/journeys/0";

  void CheckInTrouble(const Trouble& trouble) {
    figures_->Holds(trouble.name + "_not_serving", AwaitHealth(server_.address(), false));
    RobotOptions hasty = robot_;
    hasty.robot = kCalmRobot + 1;
    hasty.retry_for = std::chrono::milliseconds(0);
    const absl::Status status = RecordOne(hasty, kHasty, &ledger_);
    figures_->Holds(absl::StrCat(trouble.name, "_told_", absl::StatusCodeToString(trouble.code)),
                    status.code() == trouble.code);
    if (status.code() != trouble.code) std::cerr << status << '\n';
    if (trouble.localises) {
      const auto matched = Localize();
      figures_->AtLeast(trouble.name + "_localises", matched.value_or(0), 0.5);
      if (!matched.ok()) std::cerr << matched.status() << '\n';
    }
    if (trouble.deletes) {
      figures_->Holds(trouble.name + "_deletes", DeleteOne(calm_, kSpare).ok());
    }
  }

  const std::string control_;
  const std::string faulty_disk_;
  Figures* const figures_;
  ServerUnderTest server_;
  RobotOptions robot_;
  RobotOptions calm_;
  Ledger ledger_;
  std::map<int, std::string> maps_;
};

Trouble Controlled(const std::string& control, const std::string& fault, absl::StatusCode code) {
  const std::string path = control + "/" + fault;
  return {fault, [path] { std::ofstream{path}; }, [path] { std::filesystem::remove(path); }, code};
}

// Everything that is left, to the last block.
void Fill(const std::string& path) {
  std::ofstream ballast(path, std::ios::binary);
  const std::string block(4096, 'x');
  while (ballast.write(block.data(), static_cast<std::streamsize>(block.size())).flush()) {
  }
}

}  // namespace

void CheckFullDisk(const Programs& programs, const std::string& folder, Figures* figures) {
  const TemporaryFolder temporary;
  const std::string control = folder.empty() ? temporary.File("control") : "";
  const std::string data = folder.empty() ? temporary.File("data") : folder + "/data";
  Trouble full = Controlled(control, "full", absl::StatusCode::kResourceExhausted);
  full.name = "full_disk";
  if (!folder.empty()) {
    const std::string ballast = folder + "/ballast";
    full.begin = [ballast] { Fill(ballast); };
    full.end = [ballast] { std::filesystem::remove(ballast); };
    full.deletes = true;
  } else {
    WriteFiles(control, {});
  }
  WriteFiles(data, {});
  Trial trial(programs, data, control, figures);
  if (!trial.Start()) return figures->Failed(full.name, "no server");
  trial.Run(full);
  trial.Stop(full.name);
}

void CheckBadDisk(const Programs& programs, Figures* figures) {
  for (const char* fault : {"bad-write", "bad-sync", "read-only"}) {
    const TemporaryFolder folder;
    const std::string control = folder.File("control");
    WriteFiles(control, {});
    WriteFiles(folder.File("data"), {});
    Trial trial(programs, folder.File("data"), control, figures);
    if (!trial.Start()) return figures->Failed(fault, "no server");
    trial.Run(Controlled(control, fault, absl::StatusCode::kUnavailable));
    trial.Stop(fault);
  }
}

void CheckLostFile(const Programs& programs, Figures* figures) {
  const TemporaryFolder folder;
  const std::string file = folder.File("data") + "/homing.db";
  WriteFiles(folder.File("data"), {});
  Trial trial(programs, folder.File("data"), "", figures);
  if (!trial.Start()) return figures->Failed("replaced_file", "no server");
  Trouble replaced{.name = "replaced_file", .begin = {}, .end = {}, .localises = false};
  replaced.begin = [file] {
    std::filesystem::rename(file, file + ".away");
    std::filesystem::copy_file(file + ".away", file);
  };
  replaced.end = [file] { std::filesystem::rename(file + ".away", file); };
  trial.Run(replaced);
  trial.Stop("replaced_file");
}

}  // namespace homing::faults
