// Runs every development sequence and simulated condition and writes what came out; see run.sh.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "homing/base/status_macros.h"
#include "tests/accuracy/fleet.h"
#include "tests/accuracy/homing_runs.h"
#include "tests/accuracy/parallel.h"
#include "tests/accuracy/picture_peers.h"
#include "tests/accuracy/pictures.h"
#include "tests/accuracy/real_runs.h"
#include "tests/accuracy/report.h"
#include "tests/accuracy/scores.h"
#include "tests/accuracy/simulated_runs.h"

namespace homing::accuracy {
namespace {

struct Flags {
  std::string server;
  std::string data;
  std::string cache;
  std::string report;
  std::string details;
  std::string pictures;
  std::string sets;
  Seeds seeds{101, 20};
  int fleet = 0;
  bool peers = true;
};

void RunPeers(std::vector<Run>& runs) {
  InParallel(runs.size(), [&](std::size_t i) {
    if (runs[i].foreign) return;
    const Differences differences = DifferencesOf(runs[i]);
    runs[i].seq_slam_5 = SeqSlam(runs[i], differences, 5);
    runs[i].seq_slam_10 = SeqSlam(runs[i], differences, 10);
    runs[i].pictures = PictureFilter(runs[i], differences);
  });
}

std::optional<client::Connection> Connect(const std::string& address) {
  if (address.empty()) return std::nullopt;
  client::ConnectionOptions options;
  options.address = address;
  auto opened = client::Connection::Open(options);
  if (!opened.ok()) Fail(opened.status().ToString());
  return *std::move(opened);
}

// Of the first run of each set.
void Measure(Measurements& all) {
  for (const Run& run : all.runs) {
    if (run.foreign || (!all.bytes.empty() && all.bytes.back().first == run.set)) continue;
    all.bytes.emplace_back(run.set, BytesACameraStep(run));
    all.microseconds.emplace_back(run.set, MicrosecondsAnObservation(run));
  }
  for (const std::int64_t steps : {1'000, 10'000}) {
    all.long_journeys.emplace_back(steps, MicrosecondsAtSteps(steps));
  }
}

// One line an answer of Homing.
void WriteDetails(const std::string& path, const std::vector<Run>& runs) {
  std::ofstream file(path);
  file << "set,run,frame,true,believed,probability,on_route,outcome,judged,right\n";
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t i = 0; i < runs[r].homing.size(); ++i) {
      const Answer& answer = runs[r].homing[i];
      file << absl::StrFormat("%s,%d,%d,%.3f,%.3f,%.4f,%.4f,%d,%d,%d\n", runs[r].set, r,
                              runs[r].query[i]->frame, runs[r].query[i]->place, answer.place,
                              answer.score, answer.on_route, static_cast<int>(answer.outcome),
                              runs[r].Judged(i), runs[r].Right(answer, i));
    }
  }
}

std::vector<const Run*> Of(const std::vector<Run>& runs, const std::string& set) {
  std::vector<const Run*> found;
  for (const Run& run : runs) {
    if (run.set == set) found.push_back(&run);
  }
  return found;
}

absl::Status DrawComparison(const std::string& folder, const std::string& set,
                            const std::vector<Run>& runs) {
  const std::vector<const Run*> found = Of(runs, set);
  if (found.empty()) return absl::OkStatus();
  const std::string name = absl::StrReplaceAll(set, {{" ", "_"}});
  HOMING_RETURN_IF_ERROR(DrawSimilarityMatrix(folder + "/matrix_" + name + ".png", *found[0]));
  std::vector<NamedCurve> curves;
  for (const auto& [method, answers] :
       {std::pair("Homing", &Run::homing), std::pair("pictures, same filter", &Run::pictures),
        std::pair("SeqSLAM, 10 frames", &Run::seq_slam_10),
        std::pair("SeqSLAM, 5 frames", &Run::seq_slam_5),
        std::pair("best P_T alone", &Run::single_frame)}) {
    curves.push_back({method, PrecisionRecallOf(Judge(found, answers))});
  }
  return DrawPrecisionRecall(folder + "/precision_recall_" + name + ".svg", set, curves);
}

absl::Status DrawPictures(const std::string& folder, const std::vector<Run>& runs) {
  for (const char* set : {"laps", "laps dim", "street two"}) {
    HOMING_RETURN_IF_ERROR(DrawComparison(folder, set, runs));
  }
  std::vector<NamedCalibration> calibrations;
  for (const bool real : {true, false}) {
    std::vector<const Run*> group;
    for (const Run& run : runs) {
      if (run.real == real && !run.foreign && !run.set.ends_with("kidnapped"))
        group.push_back(&run);
    }
    if (!group.empty()) {
      calibrations.push_back({real ? "real sequences" : "simulated routes",
                              CalibrationOf(Judge(group, &Run::homing))});
    }
  }
  return DrawReliability(folder + "/reliability.svg", calibrations);
}

int Main(const Flags& flags) {
  Measurements measurements;
  RunPlan plan;
  if (!flags.data.empty()) PlanRealRuns(flags.data, flags.cache, plan);
  if (flags.seeds.count > 0) PlanSimulatedRuns(flags.seeds, flags.cache, plan);
  measurements.runs = plan.Make(SetFilter(flags.sets));
  std::cerr << measurements.runs.size() << " runs\n";
  const std::optional<client::Connection> server = Connect(flags.server);
  InParallel(measurements.runs.size(), [&](std::size_t i) {
    LocalizeRun(server ? &*server : nullptr, static_cast<int>(i), measurements.runs[i]);
  });
  if (server && flags.fleet > 0) measurements.fleet = RunFleet(*server, {.journeys = flags.fleet});
  measurements.has_peers = flags.peers;
  if (flags.peers) RunPeers(measurements.runs);
  if (flags.peers) Measure(measurements);
  if (!flags.details.empty()) WriteDetails(flags.details, measurements.runs);
  if (!flags.pictures.empty()) {
    const absl::Status drawn = DrawPictures(flags.pictures, measurements.runs);
    if (!drawn.ok()) Fail(drawn.ToString());
  }
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
  app.add_option("--cache", flags.cache, "Folder that keeps the flow of all drives [none]");
  app.add_option("--report", flags.report, "Markdown file [standard output]");
  app.add_option("--details", flags.details, "CSV file of all answers [none]");
  app.add_option("--pictures", flags.pictures, "Folder for pictures [none]");
  app.add_option("--sets", flags.sets,
                 "Words between commas: real, simulated, foreign, a set or how one begins [all]");
  app.add_option("--seeds", flags.seeds.count, "Simulated worlds a scene");
  app.add_option("--first-seed", flags.seeds.first, "The first of them");
  app.add_option("--fleet", flags.fleet, "Journeys of a fleet, through the server [none]");
  app.add_flag("!--no-peers", flags.peers, "Homing alone");
  CLI11_PARSE(app, argc, argv);
  return homing::accuracy::Main(flags);
}
