#include "client/bench/bench_command.h"

#include <array>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/bench/load_run.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::array<double, 5> kPercentiles = {0.5, 0.9, 0.99, 0.999, 0.9999};

nlohmann::ordered_json BenchJson(const LoadOptions& options, const LoadResult& result) {
  const LoadCounts& counts = result.counts;
  nlohmann::ordered_json line{
      {"robots", options.robots},
      {"rate", options.rate},
      {"seconds", result.seconds},
      {"sent", counts.sent},
      {"answered", counts.answered},
      {"dropped", counts.sent - counts.answered},
      {"late", counts.late},
      {"failed_robots", result.failed_robots},
      {"per_second", static_cast<double>(counts.answered) / result.seconds},
  };
  for (const double share : kPercentiles) {
    line[absl::StrFormat("p%g_ms", share * 100)] = counts.latency.PercentileMs(share);
  }
  line["max_ms"] = counts.latency.max_ms();
  line["first_answer_ms"] = counts.first.max_ms();
  line["settled_p99_ms"] = counts.settled.PercentileMs(0.99);
  return line;
}

std::string Table(const LoadResult& result) {
  const LoadCounts& counts = result.counts;
  std::string text = absl::StrFormat(
      "%d observations, %.0f a second; %d not answered, %d sent late, %d robots failed\n"
      "%10s  %10s\n",
      counts.sent, static_cast<double>(counts.answered) / result.seconds,
      counts.sent - counts.answered, counts.late, result.failed_robots, "percentile", "ms");
  for (const double share : kPercentiles) {
    absl::StrAppendFormat(&text, "%9.2f%%  %10.3f\n", share * 100,
                          counts.latency.PercentileMs(share));
  }
  return text + absl::StrFormat("%10s  %10.3f", "most", counts.latency.max_ms());
}

absl::Status Bench(const Session& session, const LoadOptions& options) {
  HOMING_ASSIGN_OR_RETURN(const LoadResult result,
                          RunLoad(
                              session.connection, options,
                              [&](const std::string& text) { session.Log(text); }, session.stop));
  if (options.prepare_only) return absl::OkStatus();
  HOMING_RETURN_IF_ERROR(session.json ? session.PrintJson(BenchJson(options, result))
                                      : session.Print(Table(result)));
  return result.failed_robots == 0 ? absl::OkStatus() : result.counts.status;
}

}  // namespace

void AddBenchFlags(CLI::App& app, Session& session) {
  auto flags = std::make_shared<LoadOptions>();
  app.add_option("--robots", flags->robots, "Robots, each on its own connection")
      ->capture_default_str();
  app.add_option("--rate", flags->rate, "Observations a second of each robot")
      ->capture_default_str();
  app.add_option("--seconds", flags->seconds, "How long each robot sends")->capture_default_str();
  app.add_option("--ramp", flags->ramp_seconds,
                 "Robots begin one after the other over so many seconds")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--send", [flags](const std::string& send) { flags->frames = send == "frames"; },
         "frames or flow [flow]")
      ->check(CLI::IsMember({"frames", "flow"}));
  app.add_option("--vectors", flags->vectors, "Flow vectors an observation")->capture_default_str();
  app.add_flag("--localize", flags->localize, "Localise instead of recording");
  app.add_option("--journeys", flags->journeys, "Journeys that localising robots share")
      ->capture_default_str();
  app.add_option("--steps", flags->steps, "Steps of each of these")->capture_default_str();
  app.add_option("--prefix", flags->prefix, "First part of the robots' ids")->capture_default_str();
  app.add_flag("--prepare", flags->prepare_only, "Only record the journeys to localise on");
  app.callback(
      [flags, &session] { session.run = [flags, &session] { return Bench(session, *flags); }; });
}

}  // namespace homing::client
