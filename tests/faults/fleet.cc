#include "tests/faults/fleet.h"

#include <iostream>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"

namespace homing::faults {
namespace {

int RobotOf(const std::string& journey) {
  return std::stoi(journey.substr(std::string("robots/").size()));
}

}  // namespace

Fleet::Fleet(const RobotOptions& options, int robots, Ledger* ledger, int first_journey,
             const std::function<void(int robot)>& on_answer,
             const std::function<void(int robot, const std::string&)>& log)
    : ledger_(ledger) {
  for (int robot = 0; robot < robots; ++robot) {
    RobotOptions own = options;
    own.robot = robot;
    own.on_answer = [robot, on_answer, next = options.on_answer](std::chrono::microseconds time) {
      on_answer(robot);
      next(time);
    };
    own.log = [robot, log](const std::string& text) { log(robot, text); };
    threads_.emplace_back([this, own, first_journey] { Run(own, first_journey); });
  }
}

void Fleet::Run(RobotOptions options, int first_journey) {
  for (int number = first_journey; !stopping_; ++number) {
    const std::string journey = JourneyOf(options.robot, number);
    const absl::Status status = RecordOne(options, journey, ledger_);
    if (!status.ok()) {
      const MutexLock lock(mutex_);
      if (error_.empty()) error_ = absl::StrCat(journey, ": ", status.ToString());
      return;
    }
  }
}

void Fleet::Finish() {
  stopping_ = true;
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

bool Fleet::AwaitProgress() const {
  const std::int64_t before = TotalOf(ledger_->entries());
  for (int i = 0; i < 6000; ++i) {
    if (TotalOf(ledger_->entries()) > before) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::string Fleet::error() const {
  const MutexLock lock(mutex_);
  return error_;
}

std::int64_t TotalOf(const std::map<std::string, Acknowledged>& entries) {
  std::int64_t total = 0;
  for (const auto& [name, acknowledged] : entries) total += acknowledged.next_sequence;
  return total;
}

std::map<int, std::string> UndisturbedMaps(const std::string& address, RobotOptions options,
                                           int robots) {
  std::map<int, std::string> maps;
  Ledger ignored;
  options.address = address;
  options.pace = std::chrono::milliseconds(0);
  for (options.robot = 0; options.robot < robots; ++options.robot) {
    const std::string journey = JourneyOf(options.robot, 0);
    const absl::Status status = RecordOne(options, journey, &ignored);
    const auto map = status.ok() ? ExportOne(address, journey) : status;
    if (!map.ok()) std::cerr << journey << ": " << map.status() << '\n';
    maps[options.robot] = map.value_or("none");
  }
  return maps;
}

int CountUnlike(const std::string& address, const std::map<std::string, Acknowledged>& entries,
                const std::map<int, std::string>& maps) {
  int unlike = 0;
  for (const auto& [name, acknowledged] : entries) {
    const auto map = ExportOne(address, name);
    unlike += !map.ok() || *map != maps.at(RobotOf(name));
  }
  return unlike;
}

}  // namespace homing::faults
