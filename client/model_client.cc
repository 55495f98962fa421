#include "client/model_client.h"

#include "client/rpc_status.h"
#include "client/unary_call.h"
#include "homing/base/status_macros.h"

namespace homing::client {
ModelClient::ModelClient(const Connection* connection, std::stop_token stop)
    : connection_(connection),
      stop_(std::move(stop)),
      stub_(v1::DeviationModelService::NewStub(connection->channel())) {}

absl::StatusOr<v1::TrainDeviationModelResponse> ModelClient::Train(
    const v1::TrainDeviationModelRequest& request) {
  return CallUnary<v1::TrainDeviationModelResponse>(
      *connection_, stop_, [&](auto* context, auto* response) {
        return stub_->TrainDeviationModel(context, request, response);
      });
}

absl::StatusOr<v1::DeviationModel> ModelClient::Get(const std::string& name) {
  v1::GetDeviationModelRequest request;
  request.set_name(name);
  return CallUnary<v1::DeviationModel>(*connection_, stop_, [&](auto* context, auto* response) {
    return stub_->GetDeviationModel(context, request, response);
  });
}

}  // namespace homing::client
