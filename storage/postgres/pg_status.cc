#include "storage/postgres/pg_status.h"

#include <cstring>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace homing::storage::postgres {
namespace {

constexpr char kConflict[] = "store: conflict: ";

std::string Field(const PGresult* result, int code) {
  const char* const field = PQresultErrorField(result, code);
  return field == nullptr ? "" : field;
}

bool IsOneOf(const std::string& code, std::initializer_list<const char*> codes) {
  for (const char* const one : codes) {
    if (code == one) return true;
  }
  return false;
}

}  // namespace

absl::Status StatusOfCode(const std::string& code, const std::string& message) {
  const std::string text = absl::StrCat("store: ", message, " (SQLSTATE ", code, ")");
  // Serialization failure, deadlock.
  if (IsOneOf(code, {"40001", "40P01"})) {
    return absl::UnavailableError(absl::StrCat(kConflict, message, " (SQLSTATE ", code, ")"));
  }
  // Lock not available, too many connections, connection errors, shutdown and the like.
  if (IsOneOf(code, {"55P03", "53300"}) || absl::StartsWith(code, "08") ||
      absl::StartsWith(code, "57")) {
    return absl::UnavailableError(text);
  }
  // The primary became a standby; another host may accept writes.
  if (code == "25006") return absl::UnavailableError(text);
  if (absl::StartsWith(code, "53")) return absl::ResourceExhaustedError(text);
  if (absl::StartsWith(code, "XX0") && code != "XX000") return absl::DataLossError(text);
  if (absl::StartsWith(code, "28") || absl::StartsWith(code, "42") || code == "3D000") {
    return absl::FailedPreconditionError(text);
  }
  return absl::InternalError(text);
}

absl::Status StatusOfResult(const PGresult* result) {
  const std::string code = Field(result, PG_DIAG_SQLSTATE);
  if (code.empty()) {
    return absl::UnavailableError(absl::StrCat("store: ", PQresultErrorMessage(result)));
  }
  return StatusOfCode(code, Field(result, PG_DIAG_MESSAGE_PRIMARY));
}

absl::Status StatusOfConnection(const std::string& message) {
  const std::string text = absl::StrCat("store: ", message);
  if (absl::StrContains(message, "invalid ") && absl::StrContains(message, "URI")) {
    return absl::InvalidArgumentError(text);
  }
  for (const char* const final : {"does not exist", "authentication failed", "no password"}) {
    // Only with FATAL: the messages for a missing socket or file are alike, and these may appear
    // later.
    if (absl::StrContains(message, final) && absl::StrContains(message, "FATAL")) {
      return absl::FailedPreconditionError(text);
    }
  }
  return absl::UnavailableError(text);
}

bool IsFatal(const PGresult* result) {
  const std::string severity = Field(result, PG_DIAG_SEVERITY_NONLOCALIZED);
  return severity != "ERROR";
}

bool IsConflict(const absl::Status& status) {
  return absl::IsUnavailable(status) && absl::StartsWith(status.message(), kConflict);
}

}  // namespace homing::storage::postgres
