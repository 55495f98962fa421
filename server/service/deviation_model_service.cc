#include "server/service/deviation_model_service.h"

#include <vector>

#include "absl/time/clock.h"
#include "homing/base/status_macros.h"
#include "server/rpc/page.h"
#include "server/rpc/unary_call.h"
#include "server/service/message_conversion.h"

namespace homing::server {
namespace {

absl::Status ListModelPage(const v1::ListDeviationModelsRequest& request, ModelCatalog* models,
                           v1::ListDeviationModelsResponse* response) {
  const std::string scope = "deviationModels";
  HOMING_ASSIGN_OR_RETURN(const int size, DecodePageSize(request.page_size()));
  HOMING_ASSIGN_OR_RETURN(const std::string after, DecodePageToken(scope, request.page_token()));
  HOMING_ASSIGN_OR_RETURN(std::vector<storage::StoredModel> page, models->List(after, size + 1));
  if (page.size() > static_cast<std::size_t>(size)) {
    page.pop_back();
    response->set_next_page_token(EncodePageToken(scope, page.back().name));
  }
  for (const storage::StoredModel& model : page) {
    *response->add_models() = EncodeModel(model);
  }
  return absl::OkStatus();
}

}  // namespace

grpc::ServerUnaryReactor* DeviationModelServiceHandler::TrainDeviationModel(
    grpc::CallbackServerContext* context, const v1::TrainDeviationModelRequest* request,
    v1::TrainDeviationModelResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kTrainDeviationModel, "", response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(
            const TrainedModel trained,
            core->models.Train(request->model_id(), DecodeTraining(request->settings()),
                               absl::GetCurrentTimeNanos()));
        *response->mutable_model() = EncodeModel(trained.stored);
        if (request->include_deviations()) {
          response->mutable_deviations_px()->Assign(trained.deviations_px.begin(),
                                                    trained.deviations_px.end());
        }
        return absl::OkStatus();
      },
      &core_->long_work);
}

grpc::ServerUnaryReactor* DeviationModelServiceHandler::GetDeviationModel(
    grpc::CallbackServerContext* context, const v1::GetDeviationModelRequest* request,
    v1::DeviationModel* response) {
  return ServeUnary(
      core_, context, Rpc::kGetDeviationModel, "", response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const storage::StoredModel model,
                                core->models.Get(request->name()));
        *response = EncodeModel(model);
        return absl::OkStatus();
      },
      &core_->store_reads);
}

grpc::ServerUnaryReactor* DeviationModelServiceHandler::ListDeviationModels(
    grpc::CallbackServerContext* context, const v1::ListDeviationModelsRequest* request,
    v1::ListDeviationModelsResponse* response) {
  return ServeUnary(
      core_, context, Rpc::kListDeviationModels, "", response,
      [core = core_, request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return ListModelPage(*request, &core->models, response);
      },
      &core_->store_reads);
}

}  // namespace homing::server
