// Whole maps from the steps of their rows, and the reverse; checked, whatever the database is.
#ifndef STORAGE_MAP_ASSEMBLY_H_
#define STORAGE_MAP_ASSEMBLY_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/journey_store.h"

namespace homing::storage {

// The next step that has a row, in order; none after the last. INVALID_ARGUMENT, DATA_LOSS: a row
// that this program does not write.
using StepReader = std::function<absl::StatusOr<std::optional<JourneyStep>>()>;

// Makes the map from all rows. DATA_LOSS: they contradict each other or the record.
absl::StatusOr<JourneyMap> AssembleMap(const JourneyRecord& record, const StepReader& next);
// Makes the tail from the rows from FirstTailStep on. DATA_LOSS.
absl::StatusOr<JourneyTail> AssembleTail(const JourneyRecord& record, std::int64_t last_sequence,
                                         const StepReader& next);
absl::StatusOr<std::vector<JourneyStep>> AssembleSteps(const JourneyRecord& record,
                                                       const StepReader& next);

// JourneyStep::sequence of the last of `step_count` steps, where `sequence` is that of `step`.
std::int64_t LastSequence(std::int64_t step, std::int64_t sequence, std::int64_t step_count);

// One step as its row holds it.
JourneyStep StepOfMap(const JourneyMap& map, std::int64_t number);
// The row of a journey that begins: all counts are 0.
JourneyRecord EmptyRecord(const JourneyRecord& record);

// The row of an imported journey.
JourneyRecord FinishedRecord(const JourneyRecord& record, const JourneyMap& map);

}  // namespace homing::storage

#endif  // STORAGE_MAP_ASSEMBLY_H_
