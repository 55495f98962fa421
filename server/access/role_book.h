// Roles given to identities by a file.
#ifndef SERVER_ACCESS_ROLE_BOOK_H_
#define SERVER_ACCESS_ROLE_BOOK_H_

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "server/access/role.h"

namespace homing::server {

class RoleBook {
 public:
  // Everyone has the role of their kind (DefaultRole).
  RoleBook() = default;
  // File: [roles], "robots/r7" = "localise-only"; "robots/*" and "operators/*" are those not
  // listed. INVALID_ARGUMENT.
  static absl::StatusOr<RoleBook> Read(const std::string& path);

  Role Find(const std::string& identity) const;

 private:
  std::map<std::string, Role> roles_;
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_ROLE_BOOK_H_
