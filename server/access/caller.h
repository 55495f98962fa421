// Who calls, as far as it is proven.
#ifndef SERVER_ACCESS_CALLER_H_
#define SERVER_ACCESS_CALLER_H_

#include <string>
#include <vector>

#include "server/access/identity.h"
#include "server/access/role.h"

namespace homing::server {

// What came with a call, not yet believed.
struct Credentials {
  // "Authorization: Bearer ..." as it came; several: all of them.
  std::vector<std::string> authorizations;
  // Of the client's certificate, if TLS took one: PEM, the client's own first, and its URI names.
  std::string certificate_pem;
  std::vector<std::string> uris;
};

struct Caller {
  // "robots/r1"; empty when the server asks nobody who they are.
  std::string identity;
  Role role = Role::kNone;

  // The robot's id; empty for anyone else.
  std::string robot() const { return RobotOf(identity); }
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_CALLER_H_
