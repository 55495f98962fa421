#include "server/admission/limits.h"

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::server {

absl::Status Validate(const Limits& limits) {
  constexpr std::int64_t kMostBytes = std::int64_t{1} << 50;
  HOMING_RETURN_IF_ERROR(CheckRange("max-streams", limits.max_streams, 0, 1'000'000));
  HOMING_RETURN_IF_ERROR(CheckRange("max-robot-streams", limits.max_robot_streams, 0, 1'000'000));
  HOMING_RETURN_IF_ERROR(CheckRange("max-robot-rate", limits.max_robot_rate, 0, 1'000'000));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("max-robot-journeys", limits.max_robot_journeys, 0, 1'000'000'000));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("max-robot-bytes", limits.max_robot_bytes, 0, kMostBytes));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("max-database", limits.max_database, 0, kMostBytes));
  HOMING_RETURN_IF_ERROR(CheckRange("idle-stream-s", limits.idle_stream_s, 0, 86'400));
  HOMING_RETURN_IF_ERROR(CheckRange("keepalive-s", limits.keepalive_s, 1, 3600));
  if (limits.memory_quota != 0) {
    HOMING_RETURN_IF_ERROR(CheckRange<std::int64_t>("memory-quota", limits.memory_quota,
                                                    std::int64_t{16} << 20, std::int64_t{1} << 40));
  }
  return CheckRange<std::int64_t>("delete-after-s", limits.delete_after_s, 0, 10'000'000'000);
}

}  // namespace homing::server
