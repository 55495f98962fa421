// DeviationModelService (paper III, eqs 6 to 10).
#ifndef SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_
#define SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_

#include "homing/v1/deviation_model_service.grpc.pb.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe: gRPC calls the methods on its own threads.
class DeviationModelServiceHandler final : public v1::DeviationModelService::CallbackService {
 public:
  // `core` must outlive the service.
  explicit DeviationModelServiceHandler(ServiceCore* core) : core_(core) {}

  grpc::ServerUnaryReactor* TrainDeviationModel(grpc::CallbackServerContext* context,
                                                const v1::TrainDeviationModelRequest* request,
                                                v1::TrainDeviationModelResponse* response) override;
  grpc::ServerUnaryReactor* GetDeviationModel(grpc::CallbackServerContext* context,
                                              const v1::GetDeviationModelRequest* request,
                                              v1::DeviationModel* response) override;
  grpc::ServerUnaryReactor* ListDeviationModels(grpc::CallbackServerContext* context,
                                                const v1::ListDeviationModelsRequest* request,
                                                v1::ListDeviationModelsResponse* response) override;

 private:
  ServiceCore* const core_;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_DEVIATION_MODEL_SERVICE_H_
