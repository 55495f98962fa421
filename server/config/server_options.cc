#include "server/config/server_options.h"

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "homing/base/host_port.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "server/config/option_groups.h"

namespace homing::server {
namespace {

// The host of "host:port"; brackets of IPv6 taken off.
std::string HostOf(const std::string& address) {
  std::string host = address.substr(0, address.rfind(':'));
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return host;
}

bool IsLoopback(const std::string& address) {
  const std::string host = HostOf(address);
  // A name such as 127.example.org may be any machine's.
  const bool is_name = host.find_first_not_of("0123456789.") != std::string::npos;
  return host == "localhost" || host == "::1" || (host.rfind("127.", 0) == 0 && !is_name) ||
         address.rfind("unix:", 0) == 0;
}

absl::Status CheckListenAddress(const std::string& field, const std::string& address) {
  if (address.rfind("unix:", 0) == 0) return absl::OkStatus();
  return ParseHostPort(field, address, 0).status();
}

}  // namespace

absl::Status Validate(const ServerOptions& options) {
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("max-message", options.max_message, 65'536, 268'435'456));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("max-pixels", options.max_pixels, 256, 268'435'456));
  HOMING_RETURN_IF_ERROR(CheckRange("max-vectors", options.max_vectors, 1, 10'000'000));
  HOMING_RETURN_IF_ERROR(CheckRange("workers", options.workers, 0, 1024));
  HOMING_RETURN_IF_ERROR(
      CheckRange<std::int64_t>("map-cache", options.map_cache, 0, std::int64_t{1} << 50));
  HOMING_RETURN_IF_ERROR(CheckRange("drain-ms", options.drain_ms, 0, 600'000));
  if (options.tls_cert.empty() != options.tls_key.empty()) {
    return absl::InvalidArgumentError("tls-cert and tls-key must be given together");
  }
  if (!options.tls_client_ca.empty() && options.tls_cert.empty()) {
    return absl::InvalidArgumentError("tls-client-ca needs tls-cert and tls-key");
  }
  if (!options.tls_crl_dir.empty() && options.tls_client_ca.empty()) {
    return absl::InvalidArgumentError("tls-crl-dir needs tls-client-ca");
  }
  HOMING_RETURN_IF_ERROR(CheckRange("reload-s", options.reload_s, 1, 3600));
  HOMING_RETURN_IF_ERROR(Validate(options.limits));
  HOMING_RETURN_IF_ERROR(CheckListenAddress("listen", options.listen));
  if (HasHttp(options)) {
    HOMING_RETURN_IF_ERROR(ParseHostPort("http", options.http, 0).status());
  }
  if (HasHttp(options) && !options.insecure && !IsLoopback(options.http)) {
    return absl::InvalidArgumentError(
        absl::StrCat("http is \"", options.http,
                     "\"; it has no TLS, so that off loopback insecure is required"));
  }
  if (options.tls_cert.empty() && !options.insecure && !IsLoopback(options.listen)) {
    return absl::InvalidArgumentError(
        absl::StrCat("listen is \"", options.listen,
                     "\"; off loopback TLS is required (tls-cert, tls-key), or insecure"));
  }
  return absl::OkStatus();
}

std::string ToToml(const ServerOptions& options) {
  const auto text = [](const char* key, const std::string& value) {
    return absl::StrCat(key, " = \"", absl::CEscape(value), "\"\n");
  };
  const auto number = [](const char* key, std::int64_t value) {
    return absl::StrCat(key, " = ", value, "\n");
  };
  const auto flag = [](const char* key, bool value) {
    return absl::StrCat(key, " = ", value ? "true" : "false", "\n");
  };
  return text("listen", options.listen) + text("database", options.database) +
         text("http", HasHttp(options) ? options.http : "off") + AccessToToml(options) +
         LimitsToToml(options.limits) + number("max-message", options.max_message) +
         number("max-pixels", options.max_pixels) + number("max-vectors", options.max_vectors) +
         number("workers", options.workers) + number("drain-ms", options.drain_ms) +
         number("map-cache", options.map_cache) +
         flag("all-journeys-index", options.all_journeys_index) +
         flag("insecure", options.insecure) + flag("readonly", options.readonly) +
         flag("no-reflection", options.no_reflection);
}

}  // namespace homing::server
