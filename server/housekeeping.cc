#include "server/housekeeping.h"

#include <spdlog/spdlog.h>

#include <string>

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
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
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
    std::unique_lock lock(mutex_);
    if (stop_.wait_for(lock, kRound, [this] { return stopping_; })) {
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
  const std::int64_t now_ns = WallClockNs();
  const std::int64_t trusted_ns = clock_.TrustedSince(now_ns, std::chrono::steady_clock::now());
  const auto deleted = core_->quota.DeleteExpired(now_ns, trusted_ns);
  if (!deleted.ok()) {
    spdlog::error("delete-after-s: {}", std::string(deleted.status().message()));
  } else if (*deleted > 0) {
    spdlog::info("delete-after-s: {} finished journeys deleted", *deleted);
  }
}

}  // namespace homing::server
