// The one place that says whether a caller may do what it asks.
#ifndef SERVER_ACCESS_AUTHORIZATION_H_
#define SERVER_ACCESS_AUTHORIZATION_H_

#include <string>

#include "absl/status/status.h"
#include "server/access/caller.h"
#include "server/access/rpc.h"
#include "server/catalog/journey_catalog.h"

namespace homing::server {

// `resource` is what the request's field (TraitsOf(rpc).field) holds: a robot, a journey, or, for
// methods that read, a pattern, of which the caller then gets what JourneysFor lets through.
// PERMISSION_DENIED, in the same words whether or not such a journey exists; INVALID_ARGUMENT: no
// such name can be.
absl::Status Authorize(const Caller& caller, Rpc rpc, const std::string& resource,
                       JourneyCatalog* catalog);

// Which journeys of a pattern are there for the caller. Empty: all.
JourneyFilter JourneysFor(const Caller& caller, Rpc rpc);

}  // namespace homing::server

#endif  // SERVER_ACCESS_AUTHORIZATION_H_
