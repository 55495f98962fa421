// The address of a store: "sqlite:PATH" or "postgresql://...".
#ifndef STORAGE_DATABASE_URL_H_
#define STORAGE_DATABASE_URL_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "homing/base/field_error.h"

namespace homing::storage {

// Both schemes that libpq knows.
inline bool IsPostgresUrl(const std::string& url) {
  return absl::StartsWith(url, "postgresql://") || absl::StartsWith(url, "postgres://");
}

// The path in "sqlite:PATH"; ":memory:" for "sqlite::memory:". INVALID_ARGUMENT: another form.
inline absl::StatusOr<std::string> ParseDatabaseUrl(const std::string& url) {
  const std::string scheme = "sqlite:";
  if (url.size() <= scheme.size() || !absl::StartsWith(url, scheme)) {
    return TextMustBe("database", url, "sqlite:PATH or postgresql://HOST/NAME");
  }
  return url.substr(scheme.size());
}

}  // namespace homing::storage

#endif  // STORAGE_DATABASE_URL_H_
