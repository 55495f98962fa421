// Robots, a thread each, that record one journey after another until stopped.
#ifndef TESTS_FAULTS_FLEET_H_
#define TESTS_FAULTS_FLEET_H_

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"
#include "tests/faults/figures.h"
#include "tests/faults/ledger.h"
#include "tests/faults/robot.h"

namespace homing::faults {

class Fleet {
 public:
  // Each robot numbers its journeys from `first_journey` on, and reports its answers to
  // `on_answer` and its other steps to `log`.
  Fleet(
      const RobotOptions& options, int robots, Ledger* ledger, int first_journey = 0,
      const std::function<void(int robot)>& on_answer = [](int) {},
      const std::function<void(int robot, const std::string&)>& log = [](int, auto&) {});
  // As Finish.
  ~Fleet() { Finish(); }

  // Each robot ends the journey that it is on.
  void Finish();
  // Waits until something more was acknowledged; false: not within a minute.
  bool AwaitProgress() const;
  // The first thing that went wrong with any robot; empty: nothing.
  std::string error() const;

 private:
  void Run(RobotOptions options, int first_journey);

  Ledger* const ledger_;
  std::atomic<bool> stopping_ = false;
  mutable Mutex mutex_;
  std::string error_;
  std::vector<std::thread> threads_;
};

// All that was acknowledged, in observations.
std::int64_t TotalOf(const std::map<std::string, Acknowledged>& entries);

// The map of each robot's route, recorded on a server that nothing happens to.
std::map<int, std::string> UndisturbedMaps(const std::string& address, RobotOptions options,
                                           int robots);

// Exports each finished journey of the ledger; how many are unlike those.
int CountUnlike(const std::string& address, const std::map<std::string, Acknowledged>& entries,
                const std::map<int, std::string>& maps);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_FLEET_H_
