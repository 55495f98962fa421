// Runs every development sequence and simulated condition and writes what came out; see run.sh.
#include <CLI/CLI.hpp>
#include <array>
#include <fstream>
#include <iostream>

#include "absl/strings/str_format.h"
#include "tests/accuracy/homing_runs.h"
#include "tests/accuracy/picture_peers.h"
#include "tests/accuracy/report.h"
#include "tests/accuracy/scores.h"
#include "tests/accuracy/sequences.h"

namespace homing::accuracy {
namespace {

struct Flags {
  std::string server;
  std::string data;
  std::string cache;
  std::string report;
  std::string details;
  int seeds = 20;
  bool peers = true;
};

// Slopes tried for the pictures' filter; the best over the real sequences is taken.
constexpr std::array<double, 6> kSlopes = {0.1, 0.2, 0.4, 0.8, 1.6, 3.2};

bool IsReal(const Run& run) {
  return run.set.find(' ') == std::string::npos || run.set == "laps dim";
}

void RunPeers(std::vector<Run>& runs) {
  std::vector<Differences> differences(runs.size());
  InParallel(runs.size(), [&](std::size_t i) {
    if (runs[i].foreign) return;
    differences[i] = DifferencesOf(runs[i]);
    runs[i].seq_slam_5 = SeqSlam(runs[i], differences[i], 5);
    runs[i].seq_slam_10 = SeqSlam(runs[i], differences[i], 10);
  });
  const auto filter = [&](double slope, bool only_real) {
    InParallel(runs.size(), [&](std::size_t i) {
      if (runs[i].foreign || (only_real && !IsReal(runs[i]))) return;
      runs[i].pictures = PictureFilter(runs[i], differences[i], slope);
    });
  };
  std::vector<const Run*> real;
  for (const Run& run : runs) {
    if (IsReal(run)) real.push_back(&run);
  }
  double best_recall = -1;
  double best_slope = kSlopes[0];
  for (const double slope : kSlopes) {
    filter(slope, true);
    const double recall = Recall(Judge(real, &Run::pictures));
    if (recall > best_recall) {
      best_recall = recall;
      best_slope = slope;
    }
  }
  std::cerr << "the pictures' filter does best with slope " << best_slope << "\n";
  filter(best_slope, false);
}

void RunHoming(const Flags& flags, std::vector<Run>& runs) {
  std::optional<client::Connection> server;
  if (!flags.server.empty()) {
    client::ConnectionOptions options;
    options.address = flags.server;
    auto opened = client::Connection::Open(options);
    if (!opened.ok()) Fail(opened.status().ToString());
    server = *std::move(opened);
  }
  InParallel(runs.size(), [&](std::size_t i) {
    LocalizeRun(server ? &*server : nullptr, static_cast<int>(i), runs[i]);
  });
}

// Of the first run of each set.
void Measure(Measurements& all) {
  for (const Run& run : all.runs) {
    if (!all.bytes.empty() && all.bytes.back().first == run.set) continue;
    all.bytes.emplace_back(run.set, BytesACameraStep(run));
    all.microseconds.emplace_back(run.set, MicrosecondsAnObservation(run));
  }
}

// One line an answer of Homing.
void WriteDetails(const std::string& path, const std::vector<Run>& runs) {
  std::ofstream file(path);
  file << "set,run,instant,true,believed,probability,outcome,judged,right\n";
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t i = 0; i < runs[r].homing.size(); ++i) {
      const Answer& answer = runs[r].homing[i];
      file << absl::StrFormat("%s,%d,%d,%.3f,%.3f,%.4f,%d,%d,%d\n", runs[r].set, r, i,
                              runs[r].query[i]->place, answer.place, answer.score,
                              static_cast<int>(answer.outcome), runs[r].Judged(i),
                              runs[r].Right(answer, i));
    }
  }
}

int Main(const Flags& flags) {
  Measurements measurements;
  if (!flags.data.empty()) measurements.runs = RealRuns(flags.data);
  if (flags.seeds > 0) {
    for (Run& run : SimulatedRuns(flags.seeds, flags.cache)) {
      measurements.runs.push_back(std::move(run));
    }
  }
  std::cerr << measurements.runs.size() << " runs\n";
  RunHoming(flags, measurements.runs);
  if (flags.peers) RunPeers(measurements.runs);
  if (flags.peers) Measure(measurements);
  if (!flags.details.empty()) WriteDetails(flags.details, measurements.runs);
  const Report report = MakeReport(measurements);
  if (!flags.report.empty()) std::ofstream(flags.report) << report.markdown;
  if (flags.report.empty()) std::cout << report.markdown;
  bool all_hold = true;
  for (const Bound& bound : report.bounds) {
    std::cout << absl::StrFormat("%-50s %8.4f %s %.4f %s\n", bound.name, bound.value,
                                 bound.at_least ? ">=" : "<=", bound.bound,
                                 bound.Holds() ? "ok" : "short");
    all_hold = all_hold && bound.Holds();
  }
  return all_hold ? 0 : 1;
}

}  // namespace
}  // namespace homing::accuracy

int main(int argc, char** argv) {
  CLI::App app("Accuracy of Homing beside methods that keep pictures");
  homing::accuracy::Flags flags;
  app.add_option("--server", flags.server, "Through this server [else by the library alone]");
  app.add_option("--data", flags.data, "Folder of real sequences [none]");
  app.add_option("--cache", flags.cache, "Folder that keeps simulated drives [none]");
  app.add_option("--report", flags.report, "Markdown file [standard output]");
  app.add_option("--details", flags.details, "CSV file of all answers [none]");
  app.add_option("--seeds", flags.seeds, "Simulated worlds a scene");
  app.add_flag("!--no-peers", flags.peers, "Homing alone");
  CLI11_PARSE(app, argc, argv);
  return homing::accuracy::Main(flags);
}
