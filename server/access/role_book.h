// Roles that a file gives to identities.
#ifndef SERVER_ACCESS_ROLE_BOOK_H_
#define SERVER_ACCESS_ROLE_BOOK_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "server/access/role.h"

namespace homing::server {

// Immutable.
class RoleBook {
 public:
  // Empty: every identity has DefaultRole.
  RoleBook() = default;
  // The file holds [roles], "robots/r7" = "localise-only". "robots/*" and "operators/*" stand for
  // identities that are not listed. INVALID_ARGUMENT, for a file without [roles] too.
  static absl::StatusOr<RoleBook> Read(const std::string& path);

  Role Find(const std::string& identity) const;

 private:
  std::map<std::string, Role> roles_;
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_ROLE_BOOK_H_
