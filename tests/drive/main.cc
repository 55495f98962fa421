// Drives robots home under every condition and prints a line for each bound: name value bound
// ok|short. Exits 1 if any is short.
// usage: homing_drive_rows [--robots N] [--rendered N] [--first-world W] [--only NAME] [--verbose]
//        [--trace I]      Of each condition, robot number I alone, with a line an observation.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_format.h"
#include "tests/drive/robots.h"

namespace homing::drive {
namespace {

struct Flags {
  int robots = 100;
  int rendered = 4;
  int first_world = 201;
  std::string only;
  bool verbose = false;
  int trace = -1;
};

std::vector<Condition> Conditions() {
  std::vector<Condition> all = {
      {.name = "plain", .least_home = 0.95, .bounds_error = true},
      {.name = "light 0.6", .home_keys = ",light=0.6", .light = 0.6, .least_home = 0.9},
      // Of 24 robots, a share so near to its bound says little.
      {.name = "quarter removed",
       .home_keys = ",remove=0.25",
       .least_home = 0.9,
       .least_robots = 100},
      {.name = "30 % lost", .lost = 0.3, .least_home = 0.9},
      {.name = "200 ms late", .delay_s = 0.2, .least_home = 0.9},
      {.name = "server restarted", .outage_s = 4, .least_home = 0.9},
      {.name = "5 fps home", .home_fps = 5, .least_home = 0.9},
      {.name = "two corners", .route_keys = ",corner=30", .least_home = 0.85},
      {.name = "carried 10 m", .carried_m = 10, .least_home = 0.85},
      {.name = "blindfolded", .blindfolded = true, .most_home = 0.1},
      {.name = "rendered plain", .rendered = true, .least_home = 0.95, .bounds_error = true},
  };
  return all;
}

std::vector<Fared> DriveAll(const Condition& condition, const Flags& flags) {
  const int robots =
      condition.rendered ? flags.rendered : std::max(flags.robots, condition.least_robots);
  std::vector<Fared> fared(static_cast<std::size_t>(robots));
  std::atomic<int> next = 0;
  const auto work = [&] {
    for (int i = next++; i < robots; i = next++) {
      fared[static_cast<std::size_t>(i)] = DriveOne(condition, i, flags.first_world + i);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back(work);
  }
  threads.clear();
  return fared;
}

// False: short.
bool Print(const std::string& name, double value, const std::string& bound, bool is_ok) {
  std::cout << absl::StrFormat("%-40s %8.3f %8s %s\n", name, value, bound, is_ok ? "ok" : "short")
            << std::flush;
  return is_ok;
}

bool Judge(const Condition& condition, const std::vector<Fared>& all) {
  std::vector<double> beside;
  int home = 0, far_off = 0;
  for (const Fared& fared : all) {
    home += fared.came_home ? 1 : 0;
    far_off += fared.most_beside_m > 2 ? 1 : 0;
    beside.insert(beside.end(), fared.beside_m.begin(), fared.beside_m.end());
  }
  std::ranges::sort(beside);
  const auto robots = static_cast<double>(all.size());
  const double share = home / robots;
  const bool is_upper = condition.most_home < 1;
  bool ok = Print(absl::StrFormat("%s: home of %d", condition.name, all.size()), share,
                  is_upper ? absl::StrFormat("<=%.2f", condition.most_home)
                           : absl::StrFormat(">=%.2f", condition.least_home),
                  share >= condition.least_home && share <= condition.most_home);
  if (!condition.bounds_error || beside.empty()) return ok;
  const double median = beside[beside.size() / 2];
  const double most = beside[beside.size() * 95 / 100];
  ok = Print(condition.name + ": median beside, m", median, "<0.30", median < 0.3) && ok;
  ok = Print(condition.name + ": 95 % beside, m", most, "<0.80", most < 0.8) && ok;
  return Print(condition.name + ": robots over 2 m", far_off, "0", far_off == 0) && ok;
}

const char* NameOf(client::PilotAnswer::Outcome outcome) {
  switch (outcome) {
    case client::PilotAnswer::Outcome::kMatch:
      return "match";
    case client::PilotAnswer::Outcome::kAmbiguous:
      return "ambiguous";
    case client::PilotAnswer::Outcome::kUnknownPlace:
      return "unknown";
  }
  return "";
}

std::string NumberOf(const std::optional<double>& value) {
  return value ? absl::StrFormat("%.3f", *value) : "-";
}

void Trace(const Fared& fared) {
  std::cout << "s\troute_m\tleft_m\theading\tbelieved\tleft_m\theading\tstate\tspeed\trate\t"
               "outcome\tprobability\thome\tturn\toffset\n";
  for (const auto& point : fared.drive.points) {
    std::cout << absl::StrFormat(
        "%.1f\t%.2f\t%.2f\t%.3f\t%.2f\t%.2f\t%.3f\t%d\t%.2f\t%.2f", point.time_s, point.route_m,
        point.left_m, point.heading, point.believed_home_m, point.believed_left_m,
        point.believed_heading, point.state, point.command.speed_mps, point.command.turn_rate);
    if (point.answer) {
      const auto& answer = *point.answer;
      std::cout << absl::StrFormat("\t%s%s\t%.2f\t%s\t%s\t%s", NameOf(answer.outcome),
                                   answer.is_standing  ? "S"
                                   : answer.is_turning ? "T"
                                                       : "",
                                   answer.probability, NumberOf(answer.progress_home),
                                   NumberOf(answer.turn), NumberOf(answer.path_offset));
    }
    std::cout << "\n";
  }
}

int Main(const Flags& flags) {
  bool ok = true;
  for (const Condition& condition : Conditions()) {
    if (!flags.only.empty() && condition.name != flags.only) continue;
    if (flags.trace >= 0) {
      Trace(DriveOne(condition, flags.trace, flags.first_world + flags.trace));
      continue;
    }
    const std::vector<Fared> fared = DriveAll(condition, flags);
    if (fared.empty()) continue;
    for (std::size_t i = 0; flags.verbose && i < fared.size(); ++i) {
      std::cerr << absl::StrFormat("%s world %d %s end %.2f most %.2f\n", condition.name,
                                   flags.first_world + static_cast<int>(i),
                                   fared[i].came_home ? "home" : "NOT HOME", fared[i].end_m,
                                   fared[i].most_beside_m);
    }
    ok = Judge(condition, fared) && ok;
  }
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace homing::drive

int main(int argc, char** argv) {
  homing::drive::Flags flags;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (name == "--verbose") {
      flags.verbose = true;
      continue;
    }
    if (name == "--robots") flags.robots = std::atoi(value);
    if (name == "--rendered") flags.rendered = std::atoi(value);
    if (name == "--first-world") flags.first_world = std::atoi(value);
    if (name == "--trace") flags.trace = std::atoi(value);
    if (name == "--only") flags.only = value;
    ++i;
  }
  return homing::drive::Main(flags);
}
