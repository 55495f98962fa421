// Who may do what: the whole table.
#ifndef SERVER_ACCESS_ROLE_H_
#define SERVER_ACCESS_ROLE_H_

#include <optional>
#include <string>

#include "server/access/rpc.h"

namespace homing::server {

enum class Role {
  // Refused whatever it asks.
  kNone,
  // Recognises places on journeys it may read; takes no map, writes nothing.
  kLocalizeOnly,
  // Writes its own journeys; reads these and what lists it among its readers.
  kRobot,
  // Reads all, takes backups, deletes, trains models; writes no journey.
  kOperator,
  // Everything.
  kAdmin,
};

// How a caller stands to a journey.
enum class Standing {
  kOwner,
  // Among the journey's readers, by name or by "*".
  kReader,
  kOther,
};

// The table.
bool Allows(Role role, Right right, Standing standing);
// True if `role` may do it to whatever journey.
inline bool AllowsAll(Role role, Right right) { return Allows(role, right, Standing::kOther); }

// "none", "localise-only", "robot", "operator", "admin".
std::string NameOf(Role role);
std::optional<Role> RoleOfName(const std::string& name);

}  // namespace homing::server

#endif  // SERVER_ACCESS_ROLE_H_
