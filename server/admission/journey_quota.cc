#include "server/admission/journey_quota.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/profile_code.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr std::int64_t kFingerprintBytes = 16;
constexpr auto kStepBytes = static_cast<std::int64_t>(2 * kProfileBytes);
constexpr std::int64_t kSecondNs = 1'000'000'000;
// Space appears only after a deletion, so frequent retries do not help.
constexpr char kRetryMs[] = "10000";
constexpr int kPage = 1000;

// Visits all journeys of `robot` (kWildcard: of all robots), page by page.
absl::Status ForEach(JourneyCatalog* catalog, const std::string& robot,
                     const std::function<void(const storage::JourneyRecord&)>& visit) {
  std::string after;
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const auto page, catalog->List(robot, after, kPage));
    for (const storage::JourneyRecord& record : page) {
      visit(record);
    }
    if (page.size() < std::size_t{kPage}) {
      return absl::OkStatus();
    }
    after = page.back().name;
  }
}

bool IsFinished(const storage::JourneyRecord& record) {
  return record.state == storage::JourneyState::kFinished;
}

absl::Status Full(const std::string& robot, const char* reason, const std::string& what) {
  return WithReason(absl::ResourceExhaustedError(absl::StrCat("robots/", robot, " has ", what,
                                                              "; delete some of its journeys")),
                    {reason, {{kRetryAfterMs, kRetryMs}}});
}

}  // namespace

std::int64_t QuotaBytes(const storage::JourneyRecord& record) {
  return record.fingerprint_count * kFingerprintBytes + record.step_count * kStepBytes;
}

std::int64_t QuotaBytes(const JourneyMap& map) {
  const auto fingerprints = static_cast<std::int64_t>(map.all_fingerprints().size());
  return fingerprints * kFingerprintBytes + map.step_count() * kStepBytes;
}

absl::StatusOr<JourneyQuota::Usage> JourneyQuota::UsageOf(const std::string& robot) {
  Usage usage;
  HOMING_RETURN_IF_ERROR(ForEach(catalog_, robot, [&](const storage::JourneyRecord& record) {
    ++usage.journeys;
    usage.bytes += QuotaBytes(record);
    if (IsFinished(record)) {
      usage.finished.push_back(record);
    }
  }));
  std::stable_sort(usage.finished.begin(), usage.finished.end(), [](const auto& a, const auto& b) {
    return a.create_time_ns < b.create_time_ns;
  });
  return usage;
}

absl::Status JourneyQuota::FindExcess(const std::string& robot, const Usage& usage,
                                      const Usage& more) const {
  const std::int64_t most = limits_.max_robot_journeys;
  if (most > 0 && more.journeys > 0 && usage.journeys + more.journeys > most) {
    return Full(robot, "ROBOT_JOURNEYS",
                absl::StrCat(usage.journeys, " journeys and max-robot-journeys is ", most));
  }
  const std::int64_t most_bytes = limits_.max_robot_bytes;
  if (most_bytes > 0 && (usage.bytes >= most_bytes || usage.bytes + more.bytes > most_bytes)) {
    const std::string with =
        more.bytes > 0 ? absl::StrCat(", with this journey ", usage.bytes + more.bytes, ",") : "";
    return Full(robot, "ROBOT_BYTES",
                absl::StrCat(usage.bytes, " bytes", with, " and max-robot-bytes is ", most_bytes));
  }
  return absl::OkStatus();
}

absl::Status JourneyQuota::Delete(const std::string& name) {
  const absl::Status status = catalog_->Delete(name);
  if (status.ok()) {
    ++deleted_;
  }
  return absl::IsNotFound(status) ? absl::OkStatus() : status;
}

absl::Status JourneyQuota::Check(const std::string& robot, const Usage& more) {
  HOMING_ASSIGN_OR_RETURN(Usage usage, UsageOf(robot));
  absl::Status excess = FindExcess(robot, usage, more);
  if (!limits_.delete_oldest) {
    return excess;
  }
  std::vector<std::string> names;
  for (const storage::JourneyRecord& oldest : usage.finished) {
    if (excess.ok()) {
      break;
    }
    names.push_back(oldest.name);
    --usage.journeys;
    usage.bytes -= QuotaBytes(oldest);
    excess = FindExcess(robot, usage, more);
  }
  HOMING_RETURN_IF_ERROR(excess);
  for (const std::string& name : names) {
    HOMING_RETURN_IF_ERROR(Delete(name));
    spdlog::info("delete-oldest: {} deleted", name);
  }
  return absl::OkStatus();
}

absl::Status JourneyQuota::CheckNew(const std::string& name, std::int64_t bytes) {
  const bool is_limited = limits_.max_robot_journeys > 0 || limits_.max_robot_bytes > 0;
  if (!is_limited || catalog_->Get(name).ok()) {
    return absl::OkStatus();
  }
  HOMING_ASSIGN_OR_RETURN(const JourneyName parsed, ParseJourneyName(name, "journey"));
  return Check(parsed.robot, {.journeys = 1, .bytes = bytes, .finished = {}});
}

absl::Status JourneyQuota::CheckGrowth(const std::string& name) {
  if (limits_.max_robot_bytes == 0) {
    return absl::OkStatus();
  }
  HOMING_ASSIGN_OR_RETURN(const JourneyName parsed, ParseJourneyName(name, "journey"));
  return Check(parsed.robot, {});
}

absl::StatusOr<std::int64_t> JourneyQuota::DeleteExpired(std::int64_t now_ns,
                                                         std::int64_t trusted_ns) {
  if (limits_.delete_after_s == 0 || catalog_->read_only()) {
    return 0;
  }
  const std::int64_t before_ns = now_ns - limits_.delete_after_s * kSecondNs;
  std::vector<std::string> expired;
  HOMING_RETURN_IF_ERROR(ForEach(catalog_, kWildcard, [&](const storage::JourneyRecord& record) {
    if (IsFinished(record) && record.create_time_ns < before_ns &&
        record.create_time_ns >= trusted_ns) {
      expired.push_back(record.name);
    }
  }));
  for (const std::string& name : expired) {
    HOMING_RETURN_IF_ERROR(Delete(name));
  }
  return static_cast<std::int64_t>(expired.size());
}

}  // namespace homing::server
