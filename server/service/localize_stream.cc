#include "server/service/localize_stream.h"

#include <utility>

#include "homing/base/status_macros.h"
#include "server/base/resource_name.h"
#include "server/service/large_images.h"
#include "server/service/message_conversion.h"
#include "server/service/stream_messages.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxMasses = 400;

}  // namespace

// The config finds the journeys, and loads the map of a named one. The maps of a wildcard are
// loaded with the first observation, whose images have the size by which they are chosen.
WorkerPool* LocalizeStream::OtherPoolOf(const v1::LocalizeRequest& request) {
  const bool loads_maps = std::exchange(loads_maps_, false);
  if (request.has_config()) {
    const auto pattern = ParseJourneyPattern(request.config().journey(), "config.journey");
    loads_maps_ = pattern.ok() && pattern->is_pattern();
  }
  if (request.has_config() || loads_maps) return &core()->store_reads;
  return HasLargeImage(request.observation()) ? &core()->large_images : nullptr;
}

absl::Status LocalizeStream::Handle(const v1::LocalizeRequest& request) {
  return TakeMessage(
      request, session_ != nullptr, [this](const auto& config) { return Begin(config); },
      [this](const auto& observation) { return Localize(observation); });
}

absl::Status LocalizeStream::Begin(const v1::LocalizeConfig& config) {
  HOMING_RETURN_IF_ERROR(call().Authorize(config.journey()));
  HOMING_ASSIGN_OR_RETURN(LocalizationQuery query, DecodeLocalizationQuery(config));
  query.filter = call().filter();
  HOMING_ASSIGN_OR_RETURN(session_,
                          LocalizationSession::Open(&core()->catalog, query, decode_limits()));
  const std::string robot = call().RobotOf(config.robot(), config.journey());
  if (!robot.empty()) {
    HOMING_RETURN_IF_ERROR(ParseRobotName(robot, "config.robot", false).status());
  }
  presence_ = core()->fleet.Enter(robot, v1::ACTIVITY_LOCALIZING, config.journey());
  NoAnswer();
  return absl::OkStatus();
}

absl::Status LocalizeStream::Localize(const v1::Observation& observation) {
  HOMING_RETURN_IF_ERROR(call().TakeObservation());
  const TimePoint begin = std::chrono::steady_clock::now();
  HOMING_ASSIGN_OR_RETURN(const Observation decoded,
                          wire::FromProto(observation, core()->options.wire));
  HOMING_ASSIGN_OR_RETURN(const Localization localization, session_->Localize(decoded));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  core()->metrics->ObservationLocalized(localization.position.outcome, elapsed.count());
  Answer([&](v1::LocalizeResponse* answer) {
    EncodeLocalization(localization, *session_, answer);
    if (presence_) Report(*answer, localization.position.journey);
  });
  return absl::OkStatus();
}

void LocalizeStream::Report(const v1::LocalizeResponse& answer, int journey) {
  v1::Belief message;
  if (presence_->IsWatched()) {
    const LocalizationSession::Belief belief = session_->BeliefOn(journey, kMaxMasses);
    message.set_journey(session_->journey_name(journey));
    message.set_step_count(belief.step_count);
    message.set_first_step(belief.first_step);
    message.set_steps_each(belief.steps_each);
    message.mutable_masses()->Assign(belief.masses.begin(), belief.masses.end());
  }
  presence_->ReportAnswer(answer, std::move(message));
}

}  // namespace homing::server
