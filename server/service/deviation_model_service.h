// DeviationModelService (paper III, eqs 6 to 10).
#ifndef SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_
#define SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_

#include "homing/v1/deviation_model_service.pb.h"
#include "server/rpc/api_service.h"

namespace homing::server {

class DeviationModelServiceHandler final : public ApiService {
 public:
  // `core` must outlive the service.
  explicit DeviationModelServiceHandler(ServiceCore* core);

 private:
  void TrainDeviationModel(const UnaryCall::Ptr& call,
                           const v1::TrainDeviationModelRequest* request,
                           v1::TrainDeviationModelResponse* response);
  void GetDeviationModel(const UnaryCall::Ptr& call, const v1::GetDeviationModelRequest* request,
                         v1::DeviationModel* response);
  void ListDeviationModels(const UnaryCall::Ptr& call,
                           const v1::ListDeviationModelsRequest* request,
                           v1::ListDeviationModelsResponse* response);
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_
