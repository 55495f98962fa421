// Many robots for long, through restarts, cut links and bad clients: nothing lost, nothing grows.
#include <array>
#include <iostream>
#include <random>
#include <thread>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "tests/faults/bad_clients.h"
#include "tests/faults/checks.h"
#include "tests/faults/fleet.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/process_figures.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/tcp_proxy.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Fraction of the time after which the restarts are over and the initial growth has ended.
constexpr double kRestartsUntil = 0.12;
constexpr double kWarm = 0.2;
constexpr int kRestarts = 3;

// How long answers took, by the half of the time that they came in.
class Latencies {
 public:
  void Add(std::chrono::microseconds latency) {
    const MutexLock lock(mutex_);
    if (half_ >= 0)
      milliseconds_[static_cast<std::size_t>(half_)].push_back(
          static_cast<double>(latency.count()) / 1000);
  }
  // -1: not counted.
  void SetHalf(int half) {
    const MutexLock lock(mutex_);
    half_ = half;
  }
  std::vector<double> Of(int half) const {
    const MutexLock lock(mutex_);
    return milliseconds_[static_cast<std::size_t>(half)];
  }

 private:
  mutable Mutex mutex_;
  int half_ = -1;
  std::array<std::vector<double>, 2> milliseconds_;
};

// Latencies of robots on an undisturbed link, and of those on the cut link, which include the time
// until they are connected again.
struct LinkLatencies {
  Latencies whole;
  Latencies cut;

  void SetHalf(int half) {
    whole.SetHalf(half);
    cut.SetHalf(half);
  }
  // On either link.
  std::vector<double> Of(int half) const {
    std::vector<double> all = whole.Of(half);
    const std::vector<double> others = cut.Of(half);
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }
};

// Records, comes home and deletes, over and over.
class SoakFleet {
 public:
  // Every second robot is on the broken link.
  SoakFleet(const RobotOptions& options, int robots, const std::string& broken_link, Ledger* ledger,
            LinkLatencies* latencies)
      : ledger_(ledger) {
    for (int robot = 0; robot < robots; ++robot) {
      RobotOptions own = options;
      own.robot = robot;
      const bool is_cut = robot % 2 == 1;
      if (is_cut) own.address = broken_link;
      Latencies* const waited = is_cut ? &latencies->cut : &latencies->whole;
      own.on_answer = [waited](std::chrono::microseconds latency) { waited->Add(latency); };
      threads_.emplace_back([this, own] { Run(own); });
    }
  }
  void Finish() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }
  int rounds() const { return rounds_; }
  std::string error() const {
    const MutexLock lock(mutex_);
    return error_;
  }

 private:
  absl::Status RunOnce(const RobotOptions& options, const std::string& journey) {
    absl::Status status = RecordOne(options, journey, ledger_);
    if (!status.ok()) return status;
    if (const auto matched = LocalizeOn(options, journey); !matched.ok()) return matched.status();
    if (stopping_) return absl::OkStatus();
    ledger_->Deleted(journey);
    status = DeleteOne(options, journey);
    // Deleted by the attempt whose answer was lost.
    return absl::IsNotFound(status) ? absl::OkStatus() : status;
  }

  void Run(const RobotOptions& options) {
    for (int number = 0; !stopping_; ++number, ++rounds_) {
      const std::string journey = JourneyOf(options.robot, number);
      const absl::Status status = RunOnce(options, journey);
      const MutexLock lock(mutex_);
      if (!status.ok() && error_.empty()) error_ = absl::StrCat(journey, ": ", status.ToString());
    }
  }

  Ledger* const ledger_;
  std::atomic<bool> stopping_ = false;
  std::atomic<int> rounds_ = 0;
  mutable Mutex mutex_;
  std::string error_;
  std::vector<std::thread> threads_;
};

void Restart(ServerUnderTest* server, bool kill) {
  if (kill) {
    server->Kill();
  } else {
    server->Stop();
  }
  server->Start();
}

struct Samples {
  std::vector<double> resident_mib;
  std::vector<double> descriptors;
};

// Lives through `length`: restarts at first, cuts all along; one sample a second once it is warm.
Samples Watch(Seconds length, ServerUnderTest* server, TcpProxy* link, LinkLatencies* latencies) {
  Samples samples;
  std::mt19937 random(11);
  int restarts = 0;
  const auto begin = Clock::now();
  while (Clock::now() - begin < length) {
    const double share = Seconds(Clock::now() - begin) / length;
    if (restarts < kRestarts && share >= kRestartsUntil * (restarts + 1) / kRestarts) {
      Restart(server, restarts++ % 2 == 1);
    }
    if (random() % 10 == 0) link->CutAll();
    link->CutAfter(random() % 2 == 0 ? -1 : static_cast<std::int64_t>(random() % 2'000'000));
    if (share >= kWarm) {
      latencies->SetHalf(share < (1 + kWarm) / 2 ? 0 : 1);
      const ProcessFigures figures = FiguresOf(server->pid());
      samples.resident_mib.push_back(figures.resident_mib);
      samples.descriptors.push_back(figures.descriptors);
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  latencies->SetHalf(-1);
  return samples;
}

void Report(const Samples& samples, const LinkLatencies& latencies, Figures* figures) {
  const double hours = 3600;
  const double resident = MeanOf(samples.resident_mib);
  const double descriptors = MeanOf(samples.descriptors);
  const auto seconds = static_cast<double>(samples.resident_mib.size());
  std::cout << "# resident " << resident << " MiB, " << descriptors << " descriptors, slopes "
            << SlopeOf(samples.resident_mib) * hours << " MiB/h, "
            << SlopeOf(samples.descriptors) * hours << " /h" << std::endl;
  figures->AtMost("soak_resident_growth_share", SlopeOf(samples.resident_mib) * seconds / resident,
                  0.1);
  figures->AtMost("soak_descriptors_growth_share",
                  SlopeOf(samples.descriptors) * seconds / descriptors, 0.1);
  const double first = QuantileOf(latencies.Of(0), 0.99);
  const double second = QuantileOf(latencies.Of(1), 0.99);
  std::cout << "# p99 " << first << " ms, then " << second << " ms; on the whole link "
            << QuantileOf(latencies.whole.Of(0), 0.99) << " ms, then "
            << QuantileOf(latencies.whole.Of(1), 0.99) << " ms" << std::endl;
  figures->AtMost("soak_p99_ratio_of_halves", first > 0 ? second / first : 99, 1.5);
}

}  // namespace

void CheckSoak(const Programs& programs, double minutes, int robots, Figures* figures) {
  const TemporaryFolder folder;
  WriteFiles(folder.File("data"), {});
  ServerUnderTest server(programs.server, folder.File("data"));
  if (!server.Start()) return figures->Failed("soak", "no server");
  LinkLatencies latencies;
  RobotOptions robot;
  robot.address = server.address();
  robot.pace = std::chrono::milliseconds(2 * robots);
  robot.frames_every = 10;
  Ledger ledger;
  TcpProxy link(server.address());
  SoakFleet fleet(robot, robots, link.address(), &ledger, &latencies);
  Samples samples;
  int visits = 0;
  {
    const BadClients bad(server.address());
    samples = Watch(Seconds(60 * minutes), &server, &link, &latencies);
    visits = bad.visits();
  }
  link.CutAfter(-1);
  fleet.Finish();
  if (!fleet.error().empty()) figures->Failed("soak", fleet.error());
  figures->AtLeast("soak_rounds", fleet.rounds(), robots);
  figures->AtLeast("soak_links", link.connections(), robots / 2);
  figures->AtLeast("soak_bad_clients", visits, 1);
  Report(samples, latencies, figures);
  figures->AtMost("soak_exit_code", server.Stop(), 0);
  const auto check = CheckDatabase(server.Url(), ledger.entries());
  if (!check.ok()) return figures->Failed("soak", check.status().ToString());
  figures->AtMost("soak_acknowledged_lost", static_cast<double>(check->lost), 0);
  figures->AtMost("soak_stored_twice", static_cast<double>(check->twice), 0);
}

}  // namespace homing::faults
