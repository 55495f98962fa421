#include "server/housekeeping.h"

#include <spdlog/spdlog.h>

#include <string>

#include "absl/time/clock.h"
#include "server/service/fleet_service.h"

namespace homing::server {
namespace {

constexpr std::chrono::seconds kRound{1};
// Interval of deletions; journeys are kept for days.
constexpr std::chrono::seconds kDeleteEvery{60};
constexpr std::chrono::seconds kCountEvery{10};
constexpr std::chrono::seconds kWarnEvery{86'400};

}  // namespace

Housekeeping::Housekeeping(ServiceCore* core, std::chrono::seconds reload_every,
                           const CertificateFiles& certificates,
                           std::function<absl::Status()> reload_more)
    : core_(core),
      reload_every_(reload_every),
      certificates_(certificates),
      reload_more_(std::move(reload_more)),
      thread_([this] { return Work(); }) {}

std::chrono::milliseconds Housekeeping::Work() {
  if (round_ > 0 && round_ % reload_every_.count() == 0) {
    Reload(AccessControl::Reading::kSettled);
  }
  core_->streams.Tick();
  if (round_ % kDeleteEvery.count() == 0) DeleteExpired();
  if (round_ % kCountEvery.count() == 0) CountJourneys();
  if (round_ % kWarnEvery.count() == 0) WarnOfExpiry();
  ++round_;
  return kRound;
}

void Housekeeping::Reload(AccessControl::Reading reading) {
  absl::Status status = core_->access->Reload(reading);
  if (reload_more_) status.Update(reload_more_());
  if (!status.ok()) {
    spdlog::error("reload failed, keeping the previous configuration: {}",
                  std::string(status.message()));
  }
}

// For watchers of the fleet: a robot appears when its first journey is created.
void Housekeeping::CountJourneys() {
  if (!core_->fleet.IsFleetWatched()) return;
  if (const absl::Status status = CountStoredJourneys(core_); !status.ok()) {
    spdlog::error("the journeys cannot be counted: {}", std::string(status.message()));
  }
}

void Housekeeping::WarnOfExpiry() {
  for (const CertificateExpiry& expiry : ReadExpiries(certificates_)) {
    const std::string warning = ExpiryWarning(expiry, absl::GetCurrentTimeNanos() / 1'000'000'000);
    if (!warning.empty()) {
      spdlog::warn("{}", warning);
    }
  }
}

void Housekeeping::DeleteExpired() {
  const std::int64_t now_ns = absl::GetCurrentTimeNanos();
  const std::int64_t trusted_ns = clock_.TrustedSince(now_ns, std::chrono::steady_clock::now());
  const auto deleted = core_->quota.DeleteExpired(now_ns, trusted_ns);
  if (!deleted.ok()) {
    spdlog::error("delete-after-s: {}", std::string(deleted.status().message()));
  } else if (*deleted > 0) {
    spdlog::info("delete-after-s: {} finished journeys deleted", *deleted);
  }
}

}  // namespace homing::server
