// HomingService.
#ifndef SERVER_SERVICE_HOMING_SERVICE_H_
#define SERVER_SERVICE_HOMING_SERVICE_H_

#include "homing/v1/homing_service.pb.h"
#include "server/rpc/api_service.h"

namespace homing::server {

class HomingServiceHandler final : public ApiService {
 public:
  // `core` must outlive the service.
  explicit HomingServiceHandler(ServiceCore* core);

 private:
  void MatchLandmarks(const UnaryCall::Ptr& call, const v1::MatchLandmarksRequest* request,
                      v1::MatchLandmarksResponse* response);
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_HOMING_SERVICE_H_
