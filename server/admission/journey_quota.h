// Limits the journeys and bytes stored for one robot, and their age.
#ifndef SERVER_ADMISSION_JOURNEY_QUOTA_H_
#define SERVER_ADMISSION_JOURNEY_QUOTA_H_

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/admission/limits.h"
#include "server/catalog/journey_catalog.h"

namespace homing::server {

// The bytes that count towards max-robot-bytes.
std::int64_t QuotaBytes(const storage::JourneyRecord& record);
std::int64_t QuotaBytes(const JourneyMap& map);

// Thread-safe. Two journeys created at the same instant may both take the last place.
class JourneyQuota {
 public:
  // `catalog` must outlive it.
  JourneyQuota(JourneyCatalog* catalog, const Limits& limits)
      : catalog_(catalog), limits_(limits) {}

  // Call it just before a journey of that name is created, when nothing else can refuse it. OK if
  // it exists. `bytes`: of a map that comes with it. RESOURCE_EXHAUSTED naming the limit; with
  // delete_oldest the robot's oldest finished journeys are deleted instead, if that makes room.
  absl::Status CheckNew(const std::string& name, std::int64_t bytes = 0);
  // Call it before a journey grows. As CheckNew, for bytes only.
  absl::Status CheckGrowth(const std::string& name);
  // Deletes finished journeys created before `now_ns` - delete_after_s, but not before
  // `trusted_ns`. Returns how many.
  absl::StatusOr<std::int64_t> DeleteExpired(std::int64_t now_ns, std::int64_t trusted_ns);

  // Journeys deleted by either rule since the start.
  std::int64_t deleted() const { return deleted_; }

 private:
  struct Usage {
    std::int64_t journeys = 0;
    std::int64_t bytes = 0;
    // Finished, the oldest first.
    std::vector<storage::JourneyRecord> finished;
  };
  absl::StatusOr<Usage> UsageOf(const std::string& robot);
  absl::Status Check(const std::string& robot, const Usage& more);
  absl::Status FindExcess(const std::string& robot, const Usage& usage, const Usage& more) const;
  absl::Status Delete(const std::string& name);

  JourneyCatalog* const catalog_;
  const Limits limits_;
  std::atomic<std::int64_t> deleted_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_JOURNEY_QUOTA_H_
