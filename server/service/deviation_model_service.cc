#include "server/service/deviation_model_service.h"

#include <vector>

#include "absl/time/clock.h"
#include "homing/base/status_macros.h"
#include "server/rpc/page.h"
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

DeviationModelServiceHandler::DeviationModelServiceHandler(ServiceCore* core) : ApiService(core) {
  AddUnary(Rpc::kTrainDeviationModel, &DeviationModelServiceHandler::TrainDeviationModel);
  AddUnary(Rpc::kGetDeviationModel, &DeviationModelServiceHandler::GetDeviationModel);
  AddUnary(Rpc::kListDeviationModels, &DeviationModelServiceHandler::ListDeviationModels);
}

void DeviationModelServiceHandler::TrainDeviationModel(
    const UnaryCall::Ptr& call, const v1::TrainDeviationModelRequest* request,
    v1::TrainDeviationModelResponse* response) {
  ServeUnary(
      call, "",
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
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
      &core()->long_work);
}

void DeviationModelServiceHandler::GetDeviationModel(const UnaryCall::Ptr& call,
                                                     const v1::GetDeviationModelRequest* request,
                                                     v1::DeviationModel* response) {
  ServeUnary(
      call, "",
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(const storage::StoredModel model,
                                core->models.Get(request->name()));
        *response = EncodeModel(model);
        return absl::OkStatus();
      },
      &core()->store_reads);
}

void DeviationModelServiceHandler::ListDeviationModels(
    const UnaryCall::Ptr& call, const v1::ListDeviationModelsRequest* request,
    v1::ListDeviationModelsResponse* response) {
  ServeUnary(
      call, "",
      [core = core(), request, response](const JourneyFilter& /*all*/) -> absl::Status {
        return ListModelPage(*request, &core->models, response);
      },
      &core()->store_reads);
}

}  // namespace homing::server
