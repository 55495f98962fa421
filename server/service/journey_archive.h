// The export file of a journey: magic, message homing.v1.JourneyMap, checksum
// (docs/storage-format.md).
#ifndef SERVER_SERVICE_JOURNEY_ARCHIVE_H_
#define SERVER_SERVICE_JOURNEY_ARCHIVE_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "storage/journey_store.h"

namespace homing::server {

// Largest file written or read: about 20 million fingerprints.
inline constexpr std::size_t kMaxArchiveBytes = std::size_t{256} * 1024 * 1024;

struct ArchivedJourney {
  // Settings, start and end time, next_sequence = step_count, finished. The rest is empty.
  storage::JourneyRecord record;
  JourneyMap map;
};

// Of `record`, only the start and end time go into the file. Same map and times, same bytes.
// INVALID_ARGUMENT: larger than kMaxArchiveBytes.
absl::StatusOr<std::string> EncodeJourney(const storage::JourneyRecord& record,
                                          const JourneyMap& map);

// INVALID_ARGUMENT saying what is wrong: not such a file, too large, damaged (truncated, changed),
// or with content that no map has.
absl::StatusOr<ArchivedJourney> DecodeJourney(std::string_view bytes);

}  // namespace homing::server

#endif  // SERVER_SERVICE_JOURNEY_ARCHIVE_H_
