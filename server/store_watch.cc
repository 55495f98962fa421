#include "server/store_watch.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {
namespace {

// Interval between two looks at the last write's result, and between two test writes.
constexpr std::chrono::milliseconds kLook{200};
constexpr std::chrono::milliseconds kTry{1000};

}  // namespace

StoreWatch::StoreWatch(storage::JourneyStore* store, OnChange on_change)
    : store_(store), on_change_(std::move(on_change)) {
  thread_ = std::thread([this] { Run(); });
}

StoreWatch::~StoreWatch() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  stopped_.NotifyOne();
  thread_.join();
}

void StoreWatch::Run() {
  bool well = true;
  while (Sleep(well ? kLook : kTry)) {
    const absl::Status status = well ? store_->WriteHealth() : store_->ProbeWrite();
    if (status.ok() == well) continue;
    well = status.ok();
    if (well) {
      spdlog::info("the store accepts writes again");
    } else {
      spdlog::error("not serving: the store accepts no writes: {}", std::string(status.message()));
    }
    on_change_(well);
  }
}

bool StoreWatch::Sleep(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  const MutexLock lock(mutex_);
  while (!stopping_ && stopped_.WaitUntil(mutex_, end)) {
  }
  return !stopping_;
}

}  // namespace homing::server
