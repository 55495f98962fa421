// The export file of a journey: magic, message homing.v1.JourneyMap, checksum
// (docs/storage-format.md).
#ifndef SERVER_SERVICE_JOURNEY_ARCHIVE_H_
#define SERVER_SERVICE_JOURNEY_ARCHIVE_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "homing/base/cancellation.h"
#include "homing/journey/journey_map.h"
#include "storage/journey_store.h"

namespace homing::server {

// Largest file written or read: about 20 million fingerprints.
inline constexpr std::size_t kMaxArchiveBytes = std::size_t{256} * 1024 * 1024;

struct ArchivedJourney {
  // Sets settings, start and end time, next_sequence = step_count, finished.
  storage::JourneyRecord record;
  JourneyMap map;
};

// Only the start and end time of `record` go into the file. Equal maps and times give equal bytes.
// INVALID_ARGUMENT: larger than kMaxArchiveBytes.
absl::StatusOr<std::string> EncodeJourney(const storage::JourneyRecord& record,
                                          const JourneyMap& map);

// INVALID_ARGUMENT with the reason: another kind of file, too large, damaged (truncated, changed),
// or with content that no map can have.
absl::StatusOr<ArchivedJourney> DecodeJourney(std::string_view bytes,
                                              const Cancellation* cancellation = nullptr);

}  // namespace homing::server

#endif  // SERVER_SERVICE_JOURNEY_ARCHIVE_H_
