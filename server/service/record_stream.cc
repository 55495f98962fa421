#include "server/service/record_stream.h"

#include <utility>

#include "homing/base/status_macros.h"
#include "server/base/resource_name.h"
#include "server/service/large_images.h"
#include "server/service/message_conversion.h"
#include "server/service/stream_messages.h"

namespace homing::server {
namespace {

// Observations between two checks of the robot's quota, which it may exceed by as many.
constexpr std::int64_t kQuotaEvery = 256;

}  // namespace

// The config claims the journey; a check of the quota lists the robot's journeys.
WorkerPool* RecordStream::OtherPoolOf(const v1::RecordJourneyRequest& request) {
  const bool is_checked = request.has_observation() && ++read_ % kQuotaEvery == 0;
  if (request.has_config() || is_checked) return &core()->store_writes;
  return HasLargeImage(request.observation()) ? &core()->large_images : nullptr;
}

absl::Status RecordStream::Handle(const v1::RecordJourneyRequest& request) {
  return TakeMessage(
      request, session_ != nullptr, [this](const auto& config) { return Begin(config); },
      [this](const auto& observation) { return Record(observation); });
}

absl::Status RecordStream::Begin(const v1::RecordingConfig& config) {
  HOMING_RETURN_IF_ERROR(call().Authorize(config.journey()));
  HOMING_RETURN_IF_ERROR(core()->quota.CheckGrowth(config.journey()));
  // Checks the name first, because the board keeps the names of robots.
  HOMING_RETURN_IF_ERROR(ParseJourneyName(config.journey(), "config.journey").status());
  journey_ = config.journey();
  const std::weak_ptr<BidiStream> weak = weak_from_this();
  presence_ = core()->fleet.Enter(call().RobotOf("", journey_), v1::ACTIVITY_RECORDING, journey_);
  RecordingListener listener;
  listener.answer = [weak, watched = std::weak_ptr(presence_)](const RecordingAnswer& answer) {
    if (const auto presence = watched.lock(); presence && answer.step) {
      presence->ReportSteps(answer.step->step + 1);
    }
    if (const auto stream = std::static_pointer_cast<RecordStream>(weak.lock())) {
      stream->Answer(
          [&](v1::RecordJourneyResponse* message) { EncodeRecordingAnswer(answer, message); });
    }
  };
  listener.end = [weak](const absl::Status& status) {
    if (const auto stream = std::static_pointer_cast<RecordStream>(weak.lock())) {
      stream->End(status);
    }
  };
  HOMING_ASSIGN_OR_RETURN(
      session_,
      RecordingSession::Open(core()->recording(decode_limits()), config.journey(),
                             config.writer_id(), core()->options.clock(), std::move(listener)));
  return absl::OkStatus();
}

absl::Status RecordStream::Record(const v1::Observation& observation) {
  if (const absl::Status status = CheckLimits(); !status.ok()) {
    session_->Reject(status);
    return absl::OkStatus();
  }
  const auto decoded = wire::FromProto(observation, core()->options.wire);
  if (decoded.ok()) {
    session_->Record(*decoded, core()->options.clock());
  } else {
    session_->Reject(decoded.status());
  }
  return absl::OkStatus();
}

absl::Status RecordStream::CheckLimits() {
  HOMING_RETURN_IF_ERROR(call().TakeObservation());
  return ++handled_ % kQuotaEvery == 0 ? core()->quota.CheckGrowth(journey_) : absl::OkStatus();
}

void RecordStream::EndInTurn(const absl::Status& status) {
  if (session_) {
    session_->Reject(status);
  } else {
    End(status);
  }
}

}  // namespace homing::server
