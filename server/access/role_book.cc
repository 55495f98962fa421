#include "server/access/role_book.h"

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"
#include "server/access/identity.h"
#include "server/access/text_table.h"

namespace homing::server {
namespace {

bool IsKind(const std::string& key) { return key == "robots/*" || key == "operators/*"; }

std::string KindOf(const std::string& identity) {
  return identity.substr(0, identity.find('/') + 1) + "*";
}

}  // namespace

absl::StatusOr<RoleBook> RoleBook::Read(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const auto table, ReadTextTable("roles", path, "roles"));
  // Without the table every identity would have its default role.
  if (!table.is_present) return NoTable("roles", path, "roles");
  RoleBook book;
  for (const auto& [identity, name] : table.entries) {
    HOMING_RETURN_IF_ERROR(IsKind(identity) ? absl::OkStatus() : CheckIdentity(identity, "roles"));
    const auto role = RoleOfName(name);
    if (!role) {
      return FlagFileError(
          "roles", path,
          absl::StrCat("gives ", identity, " the role \"", name.substr(0, 100),
                       "\", which must be none, localise-only, robot, operator or admin"));
    }
    book.roles_.emplace(identity, *role);
  }
  return book;
}

Role RoleBook::Find(const std::string& identity) const {
  for (const std::string& key : {identity, KindOf(identity)}) {
    const auto found = roles_.find(key);
    if (found != roles_.end()) {
      return found->second;
    }
  }
  return DefaultRole(identity);
}

}  // namespace homing::server
