// StoreService: the store as a whole.
#ifndef SERVER_SERVICE_STORE_SERVICE_H_
#define SERVER_SERVICE_STORE_SERVICE_H_

#include "homing/v1/store_service.pb.h"
#include "server/rpc/api_service.h"

namespace homing::server {

class StoreServiceHandler final : public ApiService {
 public:
  // `core` must outlive the service.
  explicit StoreServiceHandler(ServiceCore* core);
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_STORE_SERVICE_H_
