#include "server/access/identity.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/base/resource_name.h"

namespace homing::server {
namespace {

constexpr char kIdentityScheme[] = "homing:";
constexpr char kRobots[] = "robots/";
constexpr char kOperators[] = "operators/";

absl::Status BadNames(const char* what) {
  return WithReason(
      absl::UnauthenticatedError(absl::StrCat(
          "the certificate ", what, "; one name must be URI:homing:robots/ID or operators/ID")),
      {"BAD_CERTIFICATE", {}});
}

using CheckOfId = absl::Status (*)(const std::string& id, const std::string& field);

absl::Status CheckWith(CheckOfId check, const std::string& identity, const std::string& field) {
  for (const char* kind : {kRobots, kOperators}) {
    if (absl::StartsWith(identity, kind)) {
      return check(identity.substr(std::string(kind).size()), field);
    }
  }
  return TextMustBe(field, identity, "robots/ID or operators/ID");
}

}  // namespace

absl::Status CheckIdentity(const std::string& identity, const std::string& field) {
  return CheckWith(CheckId, identity, field);
}

absl::Status CheckNewIdentity(const std::string& identity, const std::string& field) {
  return CheckWith(CheckNewId, identity, field);
}

absl::StatusOr<std::string> IdentityOfUris(const std::vector<std::string>& uris) {
  std::string identity;
  for (const std::string& uri : uris) {
    if (!absl::StartsWith(uri, kIdentityScheme)) {
      continue;
    }
    if (!identity.empty()) {
      return BadNames("names more than one identity");
    }
    identity = std::string(absl::StripPrefix(uri, kIdentityScheme));
    if (!CheckIdentity(identity, "certificate").ok()) {
      return BadNames("names an identity of another form");
    }
  }
  if (identity.empty()) {
    return BadNames("names no identity");
  }
  return identity;
}

std::string UriOf(const std::string& identity) { return kIdentityScheme + identity; }

std::string RobotOf(const std::string& identity) {
  return absl::StartsWith(identity, kRobots) ? identity.substr(std::string(kRobots).size()) : "";
}

Role DefaultRole(const std::string& identity) {
  return absl::StartsWith(identity, kOperators) ? Role::kOperator : Role::kRobot;
}

}  // namespace homing::server
