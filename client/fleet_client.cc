#include "client/fleet_client.h"

#include <memory>
#include <string>

#include "client/rpc_status.h"
#include "homing/v1/fleet_service.grpc.pb.h"

namespace homing::client {

absl::StatusOr<std::vector<v1::Robot>> ListRobots(const Connection& connection,
                                                  const std::stop_token& stop) {
  const auto stub = v1::FleetService::NewStub(connection.channel());
  std::vector<v1::Robot> robots;
  v1::ListRobotsRequest request;
  request.set_page_size(1000);
  do {
    grpc::ClientContext context;
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    v1::ListRobotsResponse response;
    const grpc::Status status = stub->ListRobots(&context, request, &response);
    if (!status.ok()) return FromGrpc(status);
    robots.insert(robots.end(), response.robots().begin(), response.robots().end());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  return robots;
}

absl::Status WatchFleet(const Connection& connection, const std::stop_token& stop,
                        const std::function<absl::Status(const v1::WatchFleetResponse&)>& changed) {
  const auto stub = v1::FleetService::NewStub(connection.channel());
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto reader = stub->WatchFleet(&context, {});
  v1::WatchFleetResponse response;
  absl::Status result;
  while (result.ok() && reader->Read(&response)) result = changed(response);
  if (!result.ok()) context.TryCancel();
  const grpc::Status status = reader->Finish();
  return result.ok() ? FromGrpc(status) : result;
}

}  // namespace homing::client
