#include "tests/accuracy/run_plan.h"

#include <algorithm>
#include <iostream>
#include <mutex>
#include <set>

#include "absl/strings/str_split.h"
#include "tests/accuracy/parallel.h"

namespace homing::accuracy {
namespace {

// The number of steps in the tolerance, one at least; a half is rounded down.
int StepsWithin(double tolerance, const Drive& map) {
  return std::max(1, static_cast<int>(std::ceil(tolerance / StepLength(map) - 0.5 - 1e-6)));
}

}  // namespace

SetFilter::SetFilter(const std::string& words)
    : words_(absl::StrSplit(words, ',', absl::SkipEmpty())) {}

bool SetFilter::Wants(const Run& run) const {
  return words_.empty() || std::ranges::any_of(words_, [&run](const std::string& word) {
           return run.set == word || run.set.starts_with(word + " ") ||
                  run.set.starts_with(word + ":") || (word == "real" && run.real && !run.foreign) ||
                  (word == "simulated" && !run.real);
         });
}

void RunPlan::AddDrives(std::vector<std::string> names, std::function<std::vector<Drive>()> make) {
  for (const std::string& name : names) index_[name] = drives_.size();
  drives_.push_back({std::move(names), std::move(make)});
}

void RunPlan::AddDrive(const std::string& name, std::function<Drive()> make) {
  AddDrives({name}, [make = std::move(make)] {
    std::vector<Drive> one;
    one.push_back(make());
    return one;
  });
}

void RunPlan::AddRun(Run run, const std::string& map, const std::string& query,
                     std::function<void(Run&)> finish) {
  runs_.push_back({std::move(run), map, query, std::move(finish)});
}

RunPlan::Made RunPlan::MakeDrives(const SetFilter& filter) const {
  std::set<std::size_t> needed;
  for (const PlannedRun& planned : runs_) {
    if (!filter.Wants(planned.run)) continue;
    needed.insert(index_.at(planned.map));
    needed.insert(index_.at(planned.query));
  }
  const std::vector<std::size_t> order(needed.begin(), needed.end());
  Made made;
  std::mutex mutex;
  InParallel(order.size(), [&](std::size_t i) {
    const PlannedDrives& planned = drives_[order[i]];
    std::vector<Drive> drives = planned.make();
    const std::lock_guard lock(mutex);
    for (std::size_t k = 0; k < drives.size(); ++k) {
      made[planned.names[k]] = std::make_shared<const Drive>(std::move(drives[k]));
    }
    if (i % 50 == 49) std::cerr << i + 1 << " of " << order.size() << " drives\n";
  });
  return made;
}

std::vector<Run> RunPlan::Make(const SetFilter& filter) const {
  const Made made = MakeDrives(filter);
  std::vector<Run> runs;
  for (const PlannedRun& planned : runs_) {
    if (!filter.Wants(planned.run)) continue;
    Run run = planned.run;
    run.maps = {made.at(planned.map)};
    run.query_drive = made.at(planned.query);
    for (const Instant& instant : *run.query_drive) run.query.push_back(&instant);
    if (run.tolerance_steps == 0) run.tolerance_steps = StepsWithin(run.tolerance, *run.maps[0]);
    if (planned.finish) planned.finish(run);
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace homing::accuracy
