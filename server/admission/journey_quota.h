// Journeys and bytes kept of one robot, and how long. Source: own design.
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

// As it counts towards max-robot-bytes.
std::int64_t QuotaBytes(const storage::JourneyRecord& record);

// Thread-safe. Two journeys made at the same instant may both find the last place free.
class JourneyQuota {
 public:
  // `catalog` must outlive it.
  JourneyQuota(JourneyCatalog* catalog, const Limits& limits)
      : catalog_(catalog), limits_(limits) {}

  // Before a journey of that name is made; OK if it is there already. RESOURCE_EXHAUSTED naming the
  // limit; with delete_oldest the robot's oldest finished journeys go first.
  absl::Status CheckNew(const std::string& name);
  // Before it grows. As CheckNew, for bytes alone.
  absl::Status CheckGrowth(const std::string& name);
  // Deletes finished journeys made before `now_ns` - delete_after_s, but not before `trusted_ns`;
  // the number.
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
  absl::Status Check(const std::string& robot, std::int64_t more_journeys);
  absl::Status FindExcess(const std::string& robot, const Usage& usage,
                          std::int64_t more_journeys) const;
  absl::Status Delete(const std::string& name);

  JourneyCatalog* const catalog_;
  const Limits limits_;
  std::atomic<std::int64_t> deleted_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_JOURNEY_QUOTA_H_
