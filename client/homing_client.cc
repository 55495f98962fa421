#include "client/homing_client.h"

#include <algorithm>

#include "client/answer_check.h"
#include "client/exchange.h"
#include "client/rpc_status.h"
#include "client/unary_call.h"
#include "homing/base/status_macros.h"

namespace homing::client {

HomingClient::HomingClient(const Connection* connection, Log log)
    : connection_(connection),
      log_(std::move(log)),
      stub_(v1::HomingService::NewStub(connection->channel())) {}

absl::Status HomingClient::Localize(const LocalizingOptions& options,
                                    ObservationStream* observations, const OnAnswer& on_answer,
                                    const std::stop_token& stop) {
  reported_ = -1;
  priors_.clear();
  ResendBuffer buffer(observations, options.replay);
  window_ = options.window;
  replay_ = options.replay;
  return Reconnecting(*connection_, stop, log_, [&](bool* progress) {
    absl::Status status = Attempt(options, &buffer, on_answer, stop, progress);
    if (!IsReset(status)) {
      window_ = options.window;
      replay_ = options.replay;
    } else if (!*progress) {
      window_ = 1;
      replay_ = std::max(1, replay_ / 4);
    }
    return status;
  });
}

absl::Status HomingClient::Attempt(const LocalizingOptions& options, ResendBuffer* buffer,
                                   const OnAnswer& on_answer, const std::stop_token& stop,
                                   bool* progress) {
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto stream = stub_->Localize(&context);
  AnswerLimit limit(&context, connection_->options().answer_time);
  v1::LocalizeRequest config;
  *config.mutable_config() = options.config;
  const std::int64_t shift = buffer->RewindTo(reported_ + 1 - replay_);
  if (const auto prior = priors_.find(shift - 1); prior != priors_.end()) {
    *config.mutable_config()->mutable_prior() = prior->second;
  }
  stream->Write(config);
  Exchange<v1::LocalizeRequest, v1::LocalizeResponse> exchange(&context, stream.get(), &limit,
                                                               window_);
  const auto fill = [shift](const v1::Observation& observation, v1::LocalizeRequest* request) {
    *request->mutable_observation() = observation;
    request->mutable_observation()->set_sequence(observation.sequence() - shift);
    // Keeps the source's number of the frame, which the answer repeats.
    if (!observation.has_frame()) request->mutable_observation()->set_frame(observation.sequence());
  };
  const auto take = [&](const v1::LocalizeResponse& response) -> absl::Status {
    const std::int64_t sent = buffer->sent() - shift;
    HOMING_RETURN_IF_ERROR(CheckAnswer(response.sequence(), sent - 1, sent));
    v1::LocalizeResponse answer = response;
    answer.set_sequence(response.sequence() + shift);
    buffer->Acknowledge(answer.sequence() + 1);
    if (answer.sequence() <= reported_) return absl::OkStatus();
    reported_ = answer.sequence();
    KeepPrior(answer, options.replay);
    *progress = true;
    return on_answer(answer);
  };
  HOMING_RETURN_IF_ERROR(limit.Explain(exchange.Run(buffer, fill, take)));
  return reported_ + 1 < buffer->sent() ? EndedEarly() : absl::OkStatus();
}

void HomingClient::KeepPrior(const v1::LocalizeResponse& answer, int replay) {
  priors_.erase(priors_.begin(), priors_.lower_bound(answer.sequence() - replay - 1));
  if (!answer.has_step()) return;
  v1::LocalizePrior& prior = priors_[answer.sequence()];
  prior.set_journey(answer.journey());
  prior.set_step(answer.step());
  prior.set_direction(answer.direction());
  prior.set_probability(answer.probability());
  if (answer.has_path_offset()) prior.set_path_offset(answer.path_offset());
}

absl::StatusOr<v1::MatchLandmarksResponse> HomingClient::Match(
    const v1::MatchLandmarksRequest& request, const std::stop_token& stop) {
  return CallUnary<v1::MatchLandmarksResponse>(
      *connection_, stop, [&](auto* context, auto* response) {
        return stub_->MatchLandmarks(context, request, response);
      });
}

}  // namespace homing::client
