// Decides whether a caller may do what it asks. No other place does.
#ifndef SERVER_ACCESS_AUTHORIZATION_H_
#define SERVER_ACCESS_AUTHORIZATION_H_

#include <string>

#include "absl/status/status.h"
#include "server/access/caller.h"
#include "server/access/rpc.h"
#include "server/catalog/journey_catalog.h"

namespace homing::server {

// `resource` is the value of the request's field (TraitsOf(rpc).field): a robot, a journey, or, for
// methods that read, a pattern; JourneysFor then selects the journeys of the pattern.
// PERMISSION_DENIED has the same text whether or not the journey exists. INVALID_ARGUMENT: the name
// is malformed.
absl::Status Authorize(const Caller& caller, Rpc rpc, const std::string& resource,
                       JourneyCatalog* catalog);

// The journeys of a pattern that the caller may use. Empty: all.
JourneyFilter JourneysFor(const Caller& caller, Rpc rpc);

// The caller may see the live state of `robot`, "robots/r1".
bool SeesRobot(const Caller& caller, const std::string& robot);

}  // namespace homing::server

#endif  // SERVER_ACCESS_AUTHORIZATION_H_
