#include "storage/step_rows.h"

#include <array>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/profile_code.h"
#include "storage/map_assembly.h"
#include "storage/row_columns.h"
#include "storage/step_id.h"

namespace homing::storage {
namespace {

#define HOMING_STEP_COLUMNS                                               \
  "step_id, left1_landmark, left1_x, left1_y, left1_count, left1_spread," \
  " left2_landmark, left2_x, left2_y, left2_count, left2_spread,"         \
  " right1_landmark, right1_x, right1_y, right1_count, right1_spread,"    \
  " right2_landmark, right2_x, right2_y, right2_count, right2_spread,"    \
  " left_profile, right_profile, sequence"

constexpr char kInsert[] = "INSERT INTO steps (" HOMING_STEP_COLUMNS
                           ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
constexpr char kSelect[] =
    "SELECT " HOMING_STEP_COLUMNS " FROM steps WHERE step_id >= ? AND step_id < ? ORDER BY step_id";
constexpr char kSelectLast[] =
    "SELECT step_id, sequence FROM steps WHERE step_id >= ? AND step_id < ? AND sequence IS NOT "
    "NULL"
    " ORDER BY step_id DESC LIMIT 1";
constexpr char kSelectLandmarksBack[] =
    "SELECT left1_landmark, left2_landmark, right1_landmark, right2_landmark FROM steps"
    " WHERE step_id >= ? AND step_id < ? ORDER BY step_id DESC";

// Columns of a fingerprint: landmark, x, y, count, spread.
constexpr int kColumnsOfPlace = 5;
constexpr int kPlacesOfSide = 2;
constexpr int kFirstProfile = 1 + 2 * kPlacesOfSide * kColumnsOfPlace;
constexpr int kSequence = kFirstProfile + 2;

Side SideOfPlace(int place) { return Side{place / kPlacesOfSide}; }

// The place's first column in SELECT, from 0.
int ColumnOfPlace(int place) { return 1 + place * kColumnsOfPlace; }

// -1: no step holds it.
std::int32_t SmallInteger(Query& row, int column) {
  const std::int64_t value = row.Integer(column);
  return std::in_range<std::int32_t>(value) ? static_cast<std::int32_t>(value) : -1;
}

absl::Status HalfFingerprint(std::int64_t step) {
  return absl::DataLossError(
      absl::StrCat("store: step ", step, " has a fingerprint without a landmark"));
}

}  // namespace

void InsertStep(Connection& connection, std::int64_t journey_id, const JourneyStep& step) {
  std::array<std::string, 2> cells;
  for (std::size_t side = 0; side < cells.size(); ++side) {
    if (step.profiles[side]) cells[side] = EncodeProfile(*step.profiles[side]);
  }
  Query query = connection.Prepare(kInsert);
  // Columns that are not bound are NULL.
  query.ClearValues();
  query.Bind(1, StepId(journey_id, step.step));
  std::array<int, 2> next_place = {0, kPlacesOfSide};
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    const Fingerprint& fingerprint = recorded.fingerprint;
    const int before = ColumnOfPlace(next_place[static_cast<std::size_t>(recorded.side)]++);
    query.Bind(before + 1, fingerprint.landmark);
    query.Bind(before + 2, double{fingerprint.x});
    query.Bind(before + 3, double{fingerprint.y});
    query.Bind(before + 4, fingerprint.count);
    query.Bind(before + 5, recorded.spread);
  }
  for (std::size_t side = 0; side < cells.size(); ++side) {
    if (!cells[side].empty()) {
      query.BindBytes(kFirstProfile + static_cast<int>(side) + 1, cells[side]);
    }
  }
  if (step.sequence != kNextSequence) query.Bind(kSequence + 1, step.sequence);
  query.Run();
}

std::int64_t FindLastSequence(Connection& connection, std::int64_t journey_id,
                              std::int64_t step_count) {
  Query query =
      connection.Prepare(kSelectLast, StepId(journey_id, 0), StepId(journey_id, step_count));
  if (!query.Next()) return step_count == 0 ? -1 : step_count;
  return LastSequence(StepOfId(query.Integer(0)), query.Integer(1), step_count);
}

Query SelectSteps(Connection& connection, std::int64_t journey_id, std::int64_t first) {
  return connection.Prepare(kSelect, StepId(journey_id, first), StepId(journey_id + 1, 0));
}

absl::StatusOr<JourneyStep> ReadStep(Query& row) {
  JourneyStep step;
  step.step = StepOfId(row.Integer(0));
  for (int place = 0; place < 2 * kPlacesOfSide; ++place) {
    const int column = ColumnOfPlace(place);
    if (row.IsNull(column)) {
      for (int other = 1; other < kColumnsOfPlace; ++other) {
        if (!row.IsNull(column + other)) return HalfFingerprint(step.step);
      }
      continue;
    }
    RecordedFingerprint& recorded = step.fingerprints.emplace_back();
    recorded.side = SideOfPlace(place);
    recorded.fingerprint = {static_cast<float>(row.Real(column + 1)),
                            static_cast<float>(row.Real(column + 2)), SmallInteger(row, column + 3),
                            SmallInteger(row, column)};
    recorded.spread = row.Real(column + 4);
  }
  for (int side = 0; side < 2; ++side) {
    if (row.IsNull(kFirstProfile + side)) continue;
    HOMING_ASSIGN_OR_RETURN(step.profiles[static_cast<std::size_t>(side)],
                            DecodeProfile(row.Bytes(kFirstProfile + side)));
  }
  if (!row.IsNull(kSequence)) step.sequence = StoredSequence(row.Integer(kSequence));
  return step;
}

std::optional<Side> FindSide(Connection& connection, std::int64_t journey_id,
                             std::int32_t landmark) {
  Query query =
      connection.Prepare(kSelectLandmarksBack, StepId(journey_id, 0), StepId(journey_id + 1, 0));
  while (query.Next()) {
    for (int place = 0; place < 2 * kPlacesOfSide; ++place) {
      if (!query.IsNull(place) && SmallInteger(query, place) == landmark) return SideOfPlace(place);
    }
  }
  return std::nullopt;
}

}  // namespace homing::storage
