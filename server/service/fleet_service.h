// FleetService.
#ifndef SERVER_SERVICE_FLEET_SERVICE_H_
#define SERVER_SERVICE_FLEET_SERVICE_H_

#include "homing/v1/fleet_service.pb.h"
#include "server/rpc/api_service.h"

namespace homing::server {

class FleetServiceHandler final : public ApiService {
 public:
  // `core` must outlive the service.
  explicit FleetServiceHandler(ServiceCore* core);

 private:
  void ListRobots(const UnaryCall::Ptr& call, const v1::ListRobotsRequest* request,
                  v1::ListRobotsResponse* response);
};

// Counts the stored journeys of each robot again, for the board.
absl::Status CountStoredJourneys(ServiceCore* core);

}  // namespace homing::server

#endif  // SERVER_SERVICE_FLEET_SERVICE_H_
