// StoreService: the store as a whole.
#ifndef SERVER_SERVICE_STORE_SERVICE_H_
#define SERVER_SERVICE_STORE_SERVICE_H_

#include "homing/v1/store_service.grpc.pb.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe: gRPC calls the methods on its own threads.
class StoreServiceHandler final : public v1::StoreService::CallbackService {
 public:
  // `core` must outlive the service.
  explicit StoreServiceHandler(ServiceCore* core) : core_(core) {}

  grpc::ServerWriteReactor<v1::BackUpStoreResponse>* BackUpStore(
      grpc::CallbackServerContext* context, const v1::BackUpStoreRequest* request) override;

 private:
  ServiceCore* const core_;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_STORE_SERVICE_H_
