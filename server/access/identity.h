// Identities of callers: "robots/{robot}" and "operators/{operator}".
#ifndef SERVER_ACCESS_IDENTITY_H_
#define SERVER_ACCESS_IDENTITY_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/access/role.h"

namespace homing::server {

// INVALID_ARGUMENT naming `field` unless `identity` is "robots/{id}" or "operators/{id}".
absl::Status CheckIdentity(const std::string& identity, const std::string& field);

// Of an identity that gets a token or a certificate: also, its id may be that of a new robot
// (CheckNewId). Files with identities of an older version are read as they are.
absl::Status CheckNewIdentity(const std::string& identity, const std::string& field);

// The identity in a certificate's URI names, "homing:IDENTITY". UNAUTHENTICATED: not exactly one
// name has that form.
absl::StatusOr<std::string> IdentityOfUris(const std::vector<std::string>& uris);

// "homing:robots/r", the form in certificates.
std::string UriOf(const std::string& identity);

// The id of "robots/{id}"; empty for other identities.
std::string RobotOf(const std::string& identity);

// The role of an identity that the file of roles does not mention: robot or operator.
Role DefaultRole(const std::string& identity);

}  // namespace homing::server

#endif  // SERVER_ACCESS_IDENTITY_H_
