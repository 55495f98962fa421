// FleetService.
#ifndef SERVER_SERVICE_FLEET_SERVICE_H_
#define SERVER_SERVICE_FLEET_SERVICE_H_

#include "homing/v1/fleet_service.grpc.pb.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe: gRPC calls the methods on its own threads.
class FleetServiceHandler final : public v1::FleetService::CallbackService {
 public:
  // `core` must outlive the service.
  explicit FleetServiceHandler(ServiceCore* core) : core_(core) {}

  grpc::ServerUnaryReactor* ListRobots(grpc::CallbackServerContext* context,
                                       const v1::ListRobotsRequest* request,
                                       v1::ListRobotsResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchFleetResponse>* WatchFleet(
      grpc::CallbackServerContext* context, const v1::WatchFleetRequest* request) override;
  grpc::ServerWriteReactor<v1::WatchRobotResponse>* WatchRobot(
      grpc::CallbackServerContext* context, const v1::WatchRobotRequest* request) override;

 private:
  ServiceCore* const core_;
};

// Counts the stored journeys of each robot again, for the board.
absl::Status CountStoredJourneys(ServiceCore* core);

}  // namespace homing::server

#endif  // SERVER_SERVICE_FLEET_SERVICE_H_
