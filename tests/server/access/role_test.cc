// The table of rights, written out once more.
#include "server/access/role.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace homing::server {
namespace {

// The letters of the rights that a role has to a journey it stands so to.
std::string RightsOf(Role role, Standing standing) {
  std::string rights;
  const std::pair<Right, char> letters[] = {{Right::kWrite, 'W'},     {Right::kDelete, 'D'},
                                            {Right::kSee, 'S'},       {Right::kTakeMap, 'M'},
                                            {Right::kLocalize, 'L'},  {Right::kTrain, 'T'},
                                            {Right::kSeeModels, 'm'}, {Right::kBackUp, 'B'}};
  for (const auto& [right, letter] : letters) {
    if (Allows(role, right, standing)) {
      rights += letter;
    }
  }
  return rights;
}

TEST(RoleTest, EachRoleHasItsRightsAndNoOthers) {
  const struct {
    Role role;
    const char* owner;
    const char* reader;
    const char* other;
  } rows[] = {
      {Role::kNone, "", "", ""},
      {Role::kLocalizeOnly, "SLm", "SLm", "m"},
      {Role::kRobot, "WDSMLm", "SMLm", "m"},
      {Role::kOperator, "DSMLTmB", "DSMLTmB", "DSMLTmB"},
      {Role::kAdmin, "WDSMLTmB", "WDSMLTmB", "WDSMLTmB"},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(RightsOf(row.role, Standing::kOwner), row.owner) << NameOf(row.role);
    EXPECT_EQ(RightsOf(row.role, Standing::kReader), row.reader) << NameOf(row.role);
    EXPECT_EQ(RightsOf(row.role, Standing::kOther), row.other) << NameOf(row.role);
  }
}

TEST(RoleTest, EveryRoleHasANameThatFindsIt) {
  for (const Role role :
       {Role::kNone, Role::kLocalizeOnly, Role::kRobot, Role::kOperator, Role::kAdmin}) {
    EXPECT_EQ(RoleOfName(NameOf(role)), role);
  }
  EXPECT_EQ(RoleOfName("root"), std::nullopt);
}

TEST(RoleTest, TraitsStandInTheOrderOfTheEnumeration) {
  for (std::size_t i = 0; i < kRpcs.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(kRpcs[i].rpc), i) << kRpcs[i].method;
  }
}

}  // namespace
}  // namespace homing::server
