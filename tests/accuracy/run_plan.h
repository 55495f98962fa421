// Runs before their drives exist: only the drives of the sets asked for are made.
#ifndef TESTS_ACCURACY_RUN_PLAN_H_
#define TESTS_ACCURACY_RUN_PLAN_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/accuracy/run.h"

namespace homing::accuracy {

// The sets to run.
class SetFilter {
 public:
  // Words between commas: "real" (all passes of real routes), "simulated", "foreign" (real maps,
  // queries from elsewhere), a set ("office:2"), or how one begins ("office", "street"). Empty:
  // all.
  explicit SetFilter(const std::string& words);

  bool Wants(const Run& run) const;

 private:
  std::vector<std::string> words_;
};

class RunPlan {
 public:
  // One call of `make` gives the drives of these names.
  void AddDrives(std::vector<std::string> names, std::function<std::vector<Drive>()> make);
  void AddDrive(const std::string& name, std::function<Drive()> make);
  // `finish` is called once the run has its drives. If `run.tolerance_steps` is 0 it becomes the
  // number of the map's steps in the tolerance.
  void AddRun(Run run, const std::string& map, const std::string& query,
              std::function<void(Run&)> finish = {});

  // Makes the drives of the runs that are wanted, on all cores.
  std::vector<Run> Make(const SetFilter& filter) const;

 private:
  struct PlannedDrives {
    std::vector<std::string> names;
    std::function<std::vector<Drive>()> make;
  };
  struct PlannedRun {
    Run run;
    std::string map;
    std::string query;
    std::function<void(Run&)> finish;
  };
  using Made = std::map<std::string, std::shared_ptr<const Drive>>;

  Made MakeDrives(const SetFilter& filter) const;

  std::vector<PlannedDrives> drives_;
  // Index of the drives with that name.
  std::map<std::string, std::size_t> index_;
  std::vector<PlannedRun> runs_;
};

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_RUN_PLAN_H_
