// The columns of `journeys` and `deviation_models` that all stores read, and their readers. `Row`
// has Text(column), Integer(column) and Real(column).
#ifndef STORAGE_ROW_COLUMNS_H_
#define STORAGE_ROW_COLUMNS_H_

#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/journey_store.h"
#include "storage/row_words.h"
#include "storage/settings_json.h"

#define HOMING_JOURNEY_COLUMNS                                               \
  "name, state, writer_id, readers, input, next_sequence, resend_from,"      \
  " create_time_ns, start_time_ns, end_time_ns, step_count, landmark_count," \
  " fingerprint_count, coalesce(settings, '')"
#define HOMING_JOURNEYS " FROM journeys LEFT JOIN journey_settings USING (journey_id)"
#define HOMING_MODEL_COLUMNS \
  "name, mu, sigma, observations, ks_distance, width, height, training, create_time_ns"

namespace homing::storage {

// -1, which no count has, for a number beyond 32 bits.
inline std::int32_t CountOf(std::int64_t value) {
  return std::in_range<std::int32_t>(value) ? static_cast<std::int32_t>(value) : -1;
}

// A step's stored number of its frame: one that is negative is damage, and not kNextSequence.
inline std::int64_t StoredSequence(std::int64_t value) {
  return value < 0 ? std::numeric_limits<std::int64_t>::min() : value;
}

// The texts of a journey that have a form. DATA_LOSS.
template <typename Row>
absl::Status ReadForms(Row& row, JourneyRecord* record) {
  HOMING_ASSIGN_OR_RETURN(record->readers, NamesFromJson(row.Text(3)));
  HOMING_ASSIGN_OR_RETURN(record->state, StateOfWord(row.Text(1)));
  HOMING_ASSIGN_OR_RETURN(record->input, InputOfWord(row.Text(4)));
  HOMING_ASSIGN_OR_RETURN(record->settings, JourneySettingsFromJson(row.Text(13)));
  return absl::OkStatus();
}

// HOMING_JOURNEY_COLUMNS are the first columns. `forms` becomes the status of ReadForms.
template <typename Row>
JourneyRecord ReadRow(Row& row, absl::Status* forms) {
  JourneyRecord record;
  record.name = row.Text(0);
  record.writer_id = row.Text(2);
  record.next_sequence = row.Integer(5);
  record.resend_from = row.Integer(6);
  record.create_time_ns = row.Integer(7);
  record.start_time_ns = row.Integer(8);
  record.end_time_ns = row.Integer(9);
  record.step_count = row.Integer(10);
  record.landmark_count = CountOf(row.Integer(11));
  record.fingerprint_count = row.Integer(12);
  *forms = ReadForms(row, &record);
  return record;
}

// HOMING_JOURNEY_COLUMNS are the first columns. DATA_LOSS.
template <typename Row>
absl::StatusOr<JourneyRecord> ReadRecord(Row& row) {
  absl::Status forms;
  JourneyRecord record = ReadRow(row, &forms);
  HOMING_RETURN_IF_ERROR(forms);
  return record;
}

// For lists: a damaged journey has no readers or settings there, and does not take the others
// along. Whoever reads it by its name gets the error.
template <typename Row>
JourneyRecord ReadListed(Row& row) {
  absl::Status ignored;
  return ReadRow(row, &ignored);
}

// HOMING_MODEL_COLUMNS are the first columns. DATA_LOSS.
template <typename Row>
absl::StatusOr<StoredModel> ReadModel(Row& row) {
  StoredModel stored;
  stored.name = row.Text(0);
  stored.model.mu = row.Real(1);
  stored.model.sigma = row.Real(2);
  stored.model.observations = CountOf(row.Integer(3));
  stored.model.ks_distance = row.Real(4);
  stored.model.width = CountOf(row.Integer(5));
  stored.model.height = CountOf(row.Integer(6));
  HOMING_ASSIGN_OR_RETURN(stored.training, TrainingOptionsFromJson(row.Text(7)));
  stored.create_time_ns = row.Integer(8);
  return stored;
}

// DATA_LOSS: a value that no stored model has.
inline absl::Status CheckModel(const StoredModel& stored) {
  absl::Status status = Validate(stored.model);
  if (stored.create_time_ns < 0) status.Update(absl::OutOfRangeError("create_time_ns is negative"));
  if (status.ok()) return status;
  return absl::DataLossError(absl::StrCat("store: deviation model '", stored.name,
                                          "' is damaged: ", std::string(status.message())));
}

}  // namespace homing::storage

#endif  // STORAGE_ROW_COLUMNS_H_
