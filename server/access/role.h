// The table of rights: which role may call which method.
#ifndef SERVER_ACCESS_ROLE_H_
#define SERVER_ACCESS_ROLE_H_

#include <optional>
#include <string>

#include "server/access/rpc.h"

namespace homing::server {

enum class Role {
  // Every call is refused.
  kNone,
  // Localises on journeys that it may read; exports no map and writes nothing.
  kLocalizeOnly,
  // Writes its own journeys; reads them and those that list it as a reader.
  kRobot,
  // Reads all journeys, makes backups, deletes journeys, trains models; records no journey.
  kOperator,
  // Every call is allowed.
  kAdmin,
};

// The caller's relation to a journey.
enum class Standing {
  kOwner,
  // Listed among the journey's readers, by name or by "*".
  kReader,
  kOther,
};

// Looks up the table of rights.
bool Allows(Role role, Right right, Standing standing);
// `role` may call the method for any journey.
inline bool AllowsAll(Role role, Right right) { return Allows(role, right, Standing::kOther); }

// "none", "localise-only", "robot", "operator", "admin".
std::string NameOf(Role role);
std::optional<Role> RoleOfName(const std::string& name);

}  // namespace homing::server

#endif  // SERVER_ACCESS_ROLE_H_
