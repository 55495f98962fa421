#include "client/recording_client.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "client/answer_check.h"
#include "client/exchange.h"
#include "client/rpc_status.h"
#include "homing/base/status_macros.h"

namespace homing::client {

RecordingClient::RecordingClient(const Connection* connection, RecordingOptions options, Log log)
    : connection_(connection),
      options_(std::move(options)),
      log_(std::move(log)),
      stub_(v1::JourneyService::NewStub(connection->channel())) {}

absl::StatusOr<RecordingSummary> RecordingClient::Record(ObservationStream* observations,
                                                         const OnAnswer& on_answer,
                                                         const std::stop_token& stop) {
  observations_ = observations;
  ResendBuffer buffer(observations, options_.keep);
  HOMING_RETURN_IF_ERROR(Reconnecting(*connection_, stop, log_, [&](bool* progress) {
    absl::Status status = Attempt(&buffer, on_answer, stop, progress);
    one_at_a_time_ = IsReset(status) && !*progress;
    return status;
  }));
  summary_.reconnects = attempts_ - 1;
  return summary_;
}

absl::Status RecordingClient::Attempt(ResendBuffer* buffer, const OnAnswer& on_answer,
                                      const std::stop_token& stop, bool* progress) {
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto stream = stub_->RecordJourney(&context);
  AnswerLimit limit(&context, connection_->options().answer_time);
  limit.Await();
  if (absl::Status status = Begin(stream.get(), buffer, progress); !status.ok()) {
    context.TryCancel();
    return limit.Explain(status);
  }
  limit.Answered();
  limit.Continue();
  Exchange<v1::RecordJourneyRequest, v1::RecordJourneyResponse> exchange(
      &context, stream.get(), &limit, one_at_a_time_ ? 1 : options_.window);
  const auto fill = [](const v1::Observation& observation, v1::RecordJourneyRequest* request) {
    *request->mutable_observation() = observation;
  };
  const auto answer = [&](const v1::RecordJourneyResponse& response) {
    return Answer(response, buffer, on_answer, progress);
  };
  HOMING_RETURN_IF_ERROR(limit.Explain(exchange.Run(buffer, fill, answer)));
  return summary_.next_sequence < buffer->sent() ? EndedEarly() : absl::OkStatus();
}

absl::Status RecordingClient::Begin(Stream* stream, ResendBuffer* buffer, bool* progress) {
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey(options_.journey);
  request.mutable_config()->set_writer_id(options_.writer_id);
  stream->Write(request);
  v1::RecordJourneyResponse first;
  if (!stream->Read(&first)) {
    absl::Status status = FromGrpc(stream->Finish());
    return status.ok() ? EndedEarly() : status;
  }
  const std::int64_t durable = first.next_sequence();
  const std::int64_t resend_from =
      first.has_resend_from() ? std::min(first.resend_from(), durable) : durable;
  HOMING_RETURN_IF_ERROR(CheckAnswer(resend_from, durable, buffer->sent()));
  *progress = attempts_ > 0 && durable > summary_.next_sequence;
  if (attempts_++ == 0) {
    summary_.begun_at = durable;
    if (durable > 0) log_(absl::StrCat("resuming at observation ", durable));
  } else {
    log_(absl::StrCat("link restored, continuing at observation ", durable));
  }
  summary_.next_sequence = durable;
  if (first.has_frame()) observations_->set_last_frame(first.frame());
  buffer->Acknowledge(durable, resend_from);
  return buffer->Rewind(resend_from, durable);
}

absl::Status RecordingClient::Answer(const v1::RecordJourneyResponse& response,
                                     ResendBuffer* buffer, const OnAnswer& on_answer,
                                     bool* progress) {
  const std::int64_t sent = buffer->sent();
  HOMING_RETURN_IF_ERROR(CheckAnswer(response.next_sequence(), sent, sent));
  HOMING_RETURN_IF_ERROR(CheckAnswer(response.resend_from(), sent, sent));
  HOMING_RETURN_IF_ERROR(CheckAnswer(response.sequence(), sent - 1, sent));
  if (response.has_resend_from()) {
    buffer->Acknowledge(response.next_sequence(), response.resend_from());
  } else {
    buffer->Acknowledge(response.next_sequence());
  }
  summary_.next_sequence = std::max(summary_.next_sequence, response.next_sequence());
  if (!response.has_sequence() || response.sequence() <= reported_) return absl::OkStatus();
  reported_ = response.sequence();
  *progress = true;
  return on_answer(response);
}

}  // namespace homing::client
