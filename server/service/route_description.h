// Summarises the cameras' views along a journey for display.
#ifndef SERVER_SERVICE_ROUTE_DESCRIPTION_H_
#define SERVER_SERVICE_ROUTE_DESCRIPTION_H_

#include "absl/status/status.h"
#include "homing/v1/journey_service.pb.h"
#include "server/catalog/journey_catalog.h"

namespace homing::server {

// INVALID_ARGUMENT, NOT_FOUND.
absl::Status FillRouteDescription(const v1::DescribeRouteRequest& request, JourneyCatalog* catalog,
                                  v1::DescribeRouteResponse* response);

}  // namespace homing::server

#endif  // SERVER_SERVICE_ROUTE_DESCRIPTION_H_
