#include "server/config/server_options.h"

#include "absl/strings/match.h"
#include "homing/base/field_error.h"
#include "homing/base/host_port.h"
#include "homing/base/status_macros.h"
#include "server/config/option_table.h"
#include "storage/database_url.h"

namespace homing::server {
namespace {

bool IsLoopback(const std::string& address) {
  if (IsUnixSocket(address)) return true;
  const auto parsed = ParseHostPort("address", address, 0);
  if (!parsed.ok()) return false;
  const std::string& host = parsed->host;
  // A name such as 127.example.org may belong to any machine.
  const bool is_name = host.find_first_not_of("0123456789.") != std::string::npos;
  return host == "localhost" || host == "::1" || (absl::StartsWith(host, "127.") && !is_name);
}

absl::Status CheckListenAddress(const std::string& field, const std::string& address) {
  if (IsUnixSocket(address)) return absl::OkStatus();
  return ParseHostPort(field, address, 0).status();
}

// A robot drops what a server has acknowledged.
absl::Status CheckIsKept(const std::string& database) {
  if (database != "sqlite::memory:") return absl::OkStatus();
  return TextMustBe("database", database, "a file; what is in memory ends with the server");
}

// PostgreSQL limits its size by its own means; the index would not see other servers' journeys.
absl::Status CheckForPostgres(const ServerOptions& options) {
  if (!storage::IsPostgresUrl(options.database)) return absl::OkStatus();
  if (options.limits.max_database != 0) {
    return FieldError("max-database", "must be 0 with a postgresql database");
  }
  if (options.all_journeys_index) {
    return FieldError("all-journeys-index", "must not be set with a postgresql database");
  }
  return absl::OkStatus();
}

}  // namespace

bool IsOpenToAll(const ServerOptions& options) {
  return options.tokens.empty() && options.tls_client_ca.empty() && !IsLoopback(options.listen);
}

absl::Status Validate(const ServerOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRanges(options));
  if (options.tls_cert.empty() != options.tls_key.empty()) {
    return FieldError("tls-cert", "must be given together with tls-key");
  }
  if (!options.tls_client_ca.empty() && options.tls_cert.empty()) {
    return FieldError("tls-client-ca", "needs tls-cert and tls-key");
  }
  if (!options.tls_crl_dir.empty() && options.tls_client_ca.empty()) {
    return FieldError("tls-crl-dir", "needs tls-client-ca");
  }
  HOMING_RETURN_IF_ERROR(CheckListenAddress("listen", options.listen));
  if (HasHttp(options)) {
    HOMING_RETURN_IF_ERROR(ParseHostPort("http", options.http, 0).status());
  }
  if (HasHttp(options) && options.tls_cert.empty() && !options.insecure &&
      !IsLoopback(options.http)) {
    return TextMustBe("http", options.http,
                      "a loopback address without TLS; set tls-cert and tls-key, or insecure");
  }
  if (options.tls_cert.empty() && !options.insecure && !IsLoopback(options.listen)) {
    return TextMustBe("listen", options.listen,
                      "a loopback address without TLS; set tls-cert and tls-key, or insecure");
  }
  if (options.log_format != "text" && options.log_format != "json") {
    return TextMustBe("log-format", options.log_format, "text or json");
  }
  HOMING_RETURN_IF_ERROR(CheckIsKept(options.database));
  return CheckForPostgres(options);
}

}  // namespace homing::server
