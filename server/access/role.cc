#include "server/access/role.h"

#include <array>
#include <utility>

namespace homing::server {
namespace {

constexpr std::array<std::pair<Role, const char*>, 5> kNames = {{
    {Role::kNone, "none"},
    {Role::kLocalizeOnly, "localise-only"},
    {Role::kRobot, "robot"},
    {Role::kOperator, "operator"},
    {Role::kAdmin, "admin"},
}};

bool AllowsLocalizeOnly(Right right, Standing standing) {
  const bool reads = right == Right::kSee || right == Right::kLocalize;
  return right == Right::kSeeModels || (reads && standing != Standing::kOther) ||
         (right == Right::kSeeFleet && standing == Standing::kOwner);
}

bool AllowsRobot(Right right, Standing standing) {
  switch (right) {
    case Right::kWrite:
    case Right::kDelete:
    case Right::kSeeFleet:
      return standing == Standing::kOwner;
    case Right::kSee:
    case Right::kTakeMap:
    case Right::kLocalize:
      return standing != Standing::kOther;
    case Right::kTrain:
    case Right::kBackUp:
      return false;
    case Right::kSeeModels:
      return true;
  }
  return false;
}

}  // namespace

bool Allows(Role role, Right right, Standing standing) {
  switch (role) {
    case Role::kNone:
      return false;
    case Role::kLocalizeOnly:
      return AllowsLocalizeOnly(right, standing);
    case Role::kRobot:
      return AllowsRobot(right, standing);
    case Role::kOperator:
      return right != Right::kWrite;
    case Role::kAdmin:
      return true;
  }
  return false;
}

std::string NameOf(Role role) {
  for (const auto& [known, name] : kNames) {
    if (known == role) {
      return name;
    }
  }
  return "none";
}

std::optional<Role> RoleOfName(const std::string& name) {
  for (const auto& [role, known] : kNames) {
    if (name == known) {
      return role;
    }
  }
  return std::nullopt;
}

}  // namespace homing::server
