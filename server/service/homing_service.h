// HomingService.
#ifndef SERVER_SERVICE_HOMING_SERVICE_H_
#define SERVER_SERVICE_HOMING_SERVICE_H_

#include "homing/v1/homing_service.grpc.pb.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe: gRPC calls the methods on its own threads.
class HomingServiceHandler final : public v1::HomingService::CallbackService {
 public:
  // `core` must outlive the service.
  explicit HomingServiceHandler(ServiceCore* core) : core_(core) {}

  grpc::ServerUnaryReactor* MatchLandmarks(grpc::CallbackServerContext* context,
                                           const v1::MatchLandmarksRequest* request,
                                           v1::MatchLandmarksResponse* response) override;
  grpc::ServerBidiReactor<v1::LocalizeRequest, v1::LocalizeResponse>* Localize(
      grpc::CallbackServerContext* context) override;

 private:
  ServiceCore* const core_;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_HOMING_SERVICE_H_
