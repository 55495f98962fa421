// Names of those who call: "robots/{robot}" and "operators/{operator}".
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

// The identity in a certificate's names: of those that are "homing:IDENTITY". UNAUTHENTICATED: none
// is, or more than one.
absl::StatusOr<std::string> IdentityOfUris(const std::vector<std::string>& uris);

// "homing:robots/r", as it stands in a certificate.
std::string UriOf(const std::string& identity);

// The id of "robots/{id}"; empty for anyone else.
std::string RobotOf(const std::string& identity);

// What an identity that no file mentions may do: robots are robots, operators are operators.
Role DefaultRole(const std::string& identity);

}  // namespace homing::server

#endif  // SERVER_ACCESS_IDENTITY_H_
