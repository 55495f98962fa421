// The caller, as far as its identity is proven.
#ifndef SERVER_ACCESS_CALLER_H_
#define SERVER_ACCESS_CALLER_H_

#include <string>
#include <vector>

#include "server/access/identity.h"
#include "server/access/role.h"

namespace homing::server {

// The credentials of a call, not yet checked.
struct Credentials {
  // The values of the header "authorization", all of them if it is repeated.
  std::vector<std::string> authorizations;
  // The client's certificate chain in PEM, its own certificate first, and the URI names in it.
  std::string certificate_pem;
  std::vector<std::string> uris;
};

struct Caller {
  // "robots/r1"; empty when the server requires no credentials.
  std::string identity;
  Role role = Role::kNone;

  // The robot's id; empty if the caller is no robot.
  std::string robot() const { return RobotOf(identity); }
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_CALLER_H_
