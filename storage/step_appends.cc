#include "storage/step_appends.h"

#include <utility>

#include "homing/base/status_macros.h"
#include "storage/journey_rows.h"
#include "storage/row_words.h"
#include "storage/step_rows.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

constexpr char kFindActive[] =
    "SELECT journey_id, state, input, next_sequence, step_count, landmark_count,"
    " resend_from FROM journeys WHERE name = ?";
constexpr char kUpdate[] =
    "UPDATE journeys SET next_sequence = ?2, input = ?3,"
    " start_time_ns = CASE start_time_ns WHEN 0 THEN ?4 ELSE start_time_ns END,"
    " end_time_ns = CASE ?5 WHEN 0 THEN end_time_ns ELSE ?5 END,"
    " step_count = ?6, landmark_count = ?7, fingerprint_count = fingerprint_count + ?8,"
    " resend_from = ?9"
    " WHERE journey_id = ?1";

// Journeys kept between transactions; a few hundred bytes each.
constexpr std::size_t kMostKept = 4096;

}  // namespace

absl::StatusOr<GrowingJourney*> StepAppends::Find(const std::string& name) {
  if (const auto known = journeys_.find(name); known != journeys_.end()) return &known->second;
  Query query = connection_->Prepare(kFindActive, name);
  if (!query.Next()) return JourneyNotFound(name);
  GrowingJourney journey;
  journey.id = query.Integer(0);
  journey.epoch = epoch(name);
  HOMING_ASSIGN_OR_RETURN(journey.state, StateOfWord(query.Text(1)));
  HOMING_ASSIGN_OR_RETURN(journey.input, InputOfWord(query.Text(2)));
  journey.next_sequence = query.Integer(3);
  journey.step_count = query.Integer(4);
  journey.landmark_count = static_cast<std::int32_t>(query.Integer(5));
  journey.resend_from = query.Integer(6);
  journey.last_sequence = FindLastSequence(*connection_, journey.id, journey.step_count);
  return &journeys_.emplace(name, std::move(journey)).first->second;
}

absl::Status StepAppends::Append(const JourneyAppend& append) {
  HOMING_ASSIGN_OR_RETURN(GrowingJourney* const journey, Find(append.journey));
  HOMING_RETURN_IF_ERROR(
      Grow(*journey, append, [this](const GrowingJourney& grown, std::int32_t landmark) {
        return FindSide(*connection_, grown.id, landmark);
      }));
  if (append.step) InsertStep(*connection_, journey->id, *append.step);
  if (!journey->is_changed) changed_.push_back(journey);
  journey->is_changed = true;
  return absl::OkStatus();
}

void StepAppends::Write() {
  for (GrowingJourney* const journey : changed_) WriteJourney(*journey);
  changed_.clear();
  if (journeys_.size() > kMostKept) Forget();
}

void StepAppends::Forget() {
  changed_.clear();
  journeys_.clear();
}

std::int64_t StepAppends::epoch(const std::string& name) const {
  const auto found = epochs_.find(name);
  return found == epochs_.end() ? 0 : found->second;
}

std::int64_t StepAppends::Acquire(const std::string& name) {
  journeys_.erase(name);
  return epochs_[name] = ++last_epoch_;
}

void StepAppends::WriteJourney(GrowingJourney& journey) {
  connection_
      ->Prepare(kUpdate, journey.id, journey.next_sequence, Word(journey.input),
                journey.first_time_ns, journey.last_time_ns, journey.step_count,
                journey.landmark_count, journey.new_fingerprints, journey.resend_from)
      .Run();
  if (journey.new_settings) {
    SetJourneySettings(*connection_, journey.id, *journey.new_settings);
  }
  MarkWritten(journey);
}

}  // namespace homing::storage
