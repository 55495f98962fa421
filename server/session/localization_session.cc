#include "server/session/localization_session.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/localization/speed_evidence.h"
#include "server/base/error_reason.h"
#include "server/session/image_memory.h"
#include "server/session/sequence_check.h"

namespace homing::server {
namespace {

// A belief holds a mass for each step, direction and speed, some sums, and the answer's masses.
constexpr std::int64_t kBytesAStep = sizeof(float) * (2 * kSpeedCount + 6);

// Greatest accepted offset relative to the distance of the seen objects; real ones are below 1.
constexpr double kMostPathOffset = 1000;

// Interval at which the caller's right to the journeys is checked again.
constexpr std::chrono::seconds kRightsEvery{1};

// Sets the size of one camera's image.
absl::Status MeasureView(const CameraView& view, const DecodeLimits& limits, int* width,
                         int* height) {
  if (const auto* flow = std::get_if<FlowField>(&view)) {
    *width = flow->width;
    *height = flow->height;
  } else if (const auto* frame = std::get_if<Frame>(&view)) {
    HOMING_ASSIGN_OR_RETURN(const cv::Size size, MeasureGray(*frame, limits));
    *width = size.width;
    *height = size.height;
  }
  return absl::OkStatus();
}

// The memory of an observation's frames. A camera that sent none yet may send others as large.
std::int64_t BytesOf(const Observation& observation, const QueryRobot& robot,
                     const FlowOptions& options) {
  std::array<int, 2> widths{};
  std::array<int, 2> heights{};
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t from = robot.widths[side] > 0 ? side : 1 - side;
    if (!std::holds_alternative<Frame>(observation.views[from])) continue;
    widths[side] = robot.widths[from];
    heights[side] = robot.heights[from];
  }
  return ImageBytes(widths, heights, options);
}

QueryRobot RobotOf(const LocalizationQuery& query) {
  QueryRobot robot;
  robot.travel = query.travel;
  robot.cameras = query.cameras;
  return robot;
}

}  // namespace

absl::StatusOr<std::unique_ptr<LocalizationSession>> LocalizationSession::Open(
    JourneyCatalog* catalog, const LocalizationQuery& query, const DecodeLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(JourneyName pattern,
                          ParseJourneyPattern(query.journey, "config.journey"));
  HOMING_RETURN_IF_ERROR(Within("config", Validate(query.match)));
  HOMING_RETURN_IF_ERROR(Within("config", Validate(query.position)));
  for (std::size_t side = 0; side < query.cameras.size(); ++side) {
    if (query.cameras[side]) {
      HOMING_RETURN_IF_ERROR(Within(side == 0 ? "config.left_camera" : "config.right_camera",
                                    Validate(*query.cameras[side])));
    }
  }
  std::unique_ptr<LocalizationSession> session(
      new LocalizationSession(catalog, query, std::move(pattern), limits));
  HOMING_ASSIGN_OR_RETURN(session->journeys_,
                          catalog->Resolve(session->pattern_, query.filter, limits.cancellation));
  HOMING_RETURN_IF_ERROR(
      SelectJourneys(session->journeys_, session->pattern_, RobotOf(query)).status());
  if (!session->pattern_.is_pattern()) {
    HOMING_RETURN_IF_ERROR(
        catalog->LoadMaps(session->pattern_, &session->journeys_, limits.cancellation));
  }
  return session;
}

absl::Status LocalizationSession::TakeMemory() {
  std::int64_t steps = 0;
  for (const auto& journey : journeys_) steps += journey->record().step_count;
  const std::int64_t bytes = steps * kBytesAStep + image_bytes_;
  if (memory_.TrySet(bytes)) return absl::OkStatus();
  return WithReason(absl::ResourceExhaustedError(absl::StrCat(
                        "localising on ", steps, " steps with these images needs ", bytes,
                        " bytes; together with the other streams this is more than memory-quota, ",
                        catalog_->beliefs()->most(), " bytes")),
                    {"LOCALIZE_MEMORY", {}});
}

void LocalizationSession::GiveMemoryBack() {
  std::size_t held = 0;
  for (const StepMass& of_journey : localizer_->masses()) held += of_journey.mass.size();
  // None before the first step: the belief is not made yet.
  if (held > 0) memory_.Set(static_cast<std::int64_t>(held) * kBytesAStep + image_bytes_);
}

absl::Status LocalizationSession::CheckSequence(std::int64_t sequence) {
  HOMING_RETURN_IF_ERROR(CheckSequenceNumber(sequence));
  if (expected_ && sequence != *expected_) {
    return SequenceGapError(sequence, *expected_);
  }
  return absl::OkStatus();
}

absl::Status LocalizationSession::Start(const Observation& observation) {
  QueryRobot robot = RobotOf(query_);
  for (std::size_t side = 0; side < observation.views.size(); ++side) {
    HOMING_RETURN_IF_ERROR(Within(
        side == 0 ? "observation.left" : "observation.right",
        MeasureView(observation.views[side], limits_, &robot.widths[side], &robot.heights[side])));
  }
  HOMING_ASSIGN_OR_RETURN(JourneySelection selection, SelectJourneys(journeys_, pattern_, robot));
  selection.options.match = query_.match;
  selection.options.position = query_.position;
  HOMING_RETURN_IF_ERROR(Validate(selection.options));
  journeys_ = std::move(selection.journeys);
  image_bytes_ = BytesOf(observation, robot, selection.options.flow);
  HOMING_RETURN_IF_ERROR(TakeMemory());
  HOMING_RETURN_IF_ERROR(catalog_->LoadMaps(pattern_, &journeys_, limits_.cancellation));
  options_ = selection.options;
  localizer_.emplace(options_, limits_);
  return absl::OkStatus();
}

// A prior on a journey that was not selected is ignored.
absl::Status LocalizationSession::StartAt(const LocalizationPrior& prior,
                                          std::span<const JourneyRef> journeys) {
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    if (*journeys[i].name != prior.journey) continue;
    HOMING_RETURN_IF_ERROR(CheckRange("config.prior.path_offset",
                                      prior.start.path_offset.value_or(0), -kMostPathOffset,
                                      kMostPathOffset));
    PositionPrior start = prior.start;
    start.journey = static_cast<int>(i);
    return Within("config", localizer_->Start(journeys, start));
  }
  return absl::OkStatus();
}

bool LocalizationSession::IsLost(const LiveJourney& journey, bool check_rights) const {
  return journey.deleted() || (check_rights && query_.filter && !query_.filter(journey.record()));
}

absl::Status LocalizationSession::LeaveLost() {
  const auto now = std::chrono::steady_clock::now();
  const bool check_rights = now - rights_checked_ >= kRightsEvery;
  if (check_rights) rights_checked_ = now;
  const auto lost = [&](const auto& journey) { return IsLost(*journey, check_rights); };
  if (std::none_of(journeys_.begin(), journeys_.end(), lost)) return absl::OkStatus();
  const bool deleted = journeys_.front()->deleted();
  if (position_.step) {
    prior_ = LocalizationPrior{
        journey_name(position_.journey),
        {0, *position_.step, position_.direction, position_.probability, position_.path_offset}};
  }
  std::erase_if(journeys_, lost);
  if (journeys_.empty()) {
    const std::string name = absl::StrCat("journey: \"", pattern_.ToString(), "\"");
    if (deleted) return absl::NotFoundError(absl::StrCat(name, " was deleted"));
    return WithReason(
        absl::PermissionDeniedError(absl::StrCat(name, ": its readers were changed; you are none")),
        {"NOT_ALLOWED", {}});
  }
  localizer_.emplace(options_, limits_);
  started_ = false;
  return absl::OkStatus();
}

absl::StatusOr<Localization> LocalizationSession::Localize(const Observation& observation) {
  HOMING_RETURN_IF_ERROR(CheckSequence(observation.sequence));
  if (!localizer_) {
    HOMING_RETURN_IF_ERROR(Start(observation));
  }
  HOMING_RETURN_IF_ERROR(LeaveLost());
  const MapsLock lock(journeys_);
  const std::vector<JourneyRef> journeys = lock.refs();
  if (!started_ && prior_) {
    HOMING_RETURN_IF_ERROR(StartAt(*prior_, journeys));
  }
  started_ = true;
  absl::StatusOr<Localization> result = localizer_->Localize(observation, journeys);
  if (!result.ok()) return Within("observation", result.status());
  GiveMemoryBack();
  expected_ = observation.sequence + 1;
  position_ = result->position;
  return result;
}

LocalizationSession::Belief LocalizationSession::BeliefOn(int journey, std::size_t most) const {
  Belief belief;
  const auto index = static_cast<std::size_t>(journey);
  if (!localizer_ || index >= localizer_->masses().size()) return belief;
  const StepMass& held = localizer_->masses()[index];
  const std::size_t each = std::max<std::size_t>(1, (held.mass.size() + most - 1) / most);
  belief.step_count = journeys_[index]->record().step_count;
  belief.first_step = held.first;
  belief.steps_each = static_cast<std::int64_t>(each);
  belief.masses.assign((held.mass.size() + each - 1) / each, 0);
  for (std::size_t i = 0; i < held.mass.size(); ++i) belief.masses[i / each] += held.mass[i];
  return belief;
}

}  // namespace homing::server
