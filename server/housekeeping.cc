#include "server/housekeeping.h"

#include <spdlog/spdlog.h>

#include <string>

#include "homing/base/mutex.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kRound{1};
// Journeys live for days.
constexpr std::chrono::seconds kDeleteEvery{60};

}  // namespace

Housekeeping::Housekeeping(ServiceCore* core, std::chrono::seconds reload_every)
    : core_(core), reload_every_(reload_every), thread_([this] { Run(); }) {}

Housekeeping::~Housekeeping() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  stop_.NotifyAll();
  thread_.join();
}

void Housekeeping::Run() {
  for (std::int64_t round = 0;; ++round) {
    if (round > 0 && round % reload_every_.count() == 0) {
      Reload();
    }
    core_->streams.Tick();
    if (round % kDeleteEvery.count() == 0) {
      DeleteExpired();
    }
    const auto next = std::chrono::steady_clock::now() + kRound;
    const MutexLock lock(mutex_);
    while (!stopping_ && stop_.WaitUntil(mutex_, next)) {
    }
    if (stopping_) {
      return;
    }
  }
}

void Housekeeping::Reload() {
  if (const absl::Status status = core_->access->Reload(); !status.ok()) {
    spdlog::error("what was read before stays in force: {}", std::string(status.message()));
  }
}

void Housekeeping::DeleteExpired() {
  const auto deleted = core_->quota.DeleteExpired(WallClockNs());
  if (!deleted.ok()) {
    spdlog::error("delete-after-s: {}", std::string(deleted.status().message()));
  } else if (*deleted > 0) {
    spdlog::info("delete-after-s: {} finished journeys deleted", *deleted);
  }
}

}  // namespace homing::server
