#include "storage/map_rows.h"

#include "homing/base/status_macros.h"
#include "storage/map_assembly.h"
#include "storage/step_rows.h"

namespace homing::storage {
namespace {

StepReader ReaderOf(Query& row) {
  return [&row]() -> absl::StatusOr<std::optional<JourneyStep>> {
    if (!row.Next()) return std::nullopt;
    return ReadStep(row);
  };
}

}  // namespace

absl::StatusOr<JourneyMap> ReadMap(Connection& connection, const JourneyRow& journey) {
  Query row = SelectSteps(connection, journey.id, 0);
  return AssembleMap(journey.record, ReaderOf(row));
}

absl::StatusOr<std::vector<JourneyStep>> ReadSteps(Connection& connection,
                                                   const JourneyRow& journey, std::int64_t first) {
  Query row = SelectSteps(connection, journey.id, first);
  return AssembleSteps(journey.record, ReaderOf(row));
}

absl::StatusOr<JourneyTail> ReadTail(Connection& connection, const JourneyRow& journey) {
  const JourneyRecord& record = journey.record;
  const std::int64_t last_sequence = FindLastSequence(connection, journey.id, record.step_count);
  Query row =
      SelectSteps(connection, journey.id, FirstTailStep(record.settings, record.step_count));
  return AssembleTail(record, last_sequence, ReaderOf(row));
}

void WriteMap(Connection& connection, std::int64_t journey_id, const JourneyMap& map) {
  for (std::int64_t number = 0; number < map.step_count(); ++number) {
    InsertStep(connection, journey_id, StepOfMap(map, number));
  }
}

}  // namespace homing::storage
