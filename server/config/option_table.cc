#include "server/config/option_table.h"

#include <array>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/flow/observation.h"

namespace homing::server {
namespace {

using Value = ServerOption::Value;

constexpr std::int64_t kMaxCount = 1'000'000;
constexpr std::int64_t kMaxBytes = std::int64_t{1} << 50;
constexpr std::int64_t kMaxMessage = 268'435'456;

// The accessor of a member.
#define HOMING_OPTION(member) [](ServerOptions& options) -> Value { return &options.member; }

const std::array kOptions = {
    ServerOption{"listen", HOMING_OPTION(listen), "Address and port; port 0 picks one"},
    ServerOption{"database", HOMING_OPTION(database),
                 "sqlite:PATH, or postgresql://HOST/NAME for several servers"},
    ServerOption{"http", HOMING_OPTION(http),
                 "Address of the console and of GET /metrics; \"off\": none"},
    ServerOption{"http-host", HOMING_OPTION(http_host),
                 "Host names of the console, separated by commas; addresses always work"},
    ServerOption{"http-user-header", HOMING_OPTION(http_user_header),
                 "Header in which a proxy names its user; only the proxy may reach --http"},
    ServerOption{"tls-cert", HOMING_OPTION(tls_cert), "Certificate chain, PEM"},
    ServerOption{"tls-key", HOMING_OPTION(tls_key), "Its private key, PEM"},
    ServerOption{"tls-client-ca", HOMING_OPTION(tls_client_ca),
                 "Clients must show a certificate of this CA, PEM; its name "
                 "URI:homing:robots/ID is the caller's identity"},
    ServerOption{"tls-crl-dir", HOMING_OPTION(tls_crl_dir),
                 "Folder of revocation lists, PEM; each issuer must have one"},
    ServerOption{"tokens", HOMING_OPTION(tokens),
                 "File of bearer tokens, made by `homing-server token`"},
    ServerOption{"roles", HOMING_OPTION(roles),
                 "File of roles: [roles] \"robots/ID\" = \"localise-only\""},
    ServerOption{"reload-s", HOMING_OPTION(reload_s),
                 "Interval at which certificates, tokens and roles are read again, s", 1, 3600,
                 "s"},
    ServerOption{"max-streams", HOMING_OPTION(limits.max_streams),
                 "Open streams; 0: no limit, as for the max-robot-... limits and max-database", 0,
                 kMaxCount, "streams", false, true},
    ServerOption{"max-robot-streams", HOMING_OPTION(limits.max_robot_streams),
                 "Open streams of one robot", 0, kMaxCount, "streams", false, true},
    ServerOption{"max-robot-rate", HOMING_OPTION(limits.max_robot_rate),
                 "Observations of one robot a second", 0, kMaxCount, "observations a second", false,
                 true},
    ServerOption{"max-robot-journeys", HOMING_OPTION(limits.max_robot_journeys),
                 "Stored journeys of one robot", 0, 1'000'000'000, "journeys", false, true},
    ServerOption{"max-robot-bytes", HOMING_OPTION(limits.max_robot_bytes),
                 "Stored bytes of one robot", 0, kMaxBytes, "bytes", false, true},
    ServerOption{"max-database", HOMING_OPTION(limits.max_database), "Size of the database", 0,
                 kMaxBytes, "bytes", false, true},
    ServerOption{"memory-quota", HOMING_OPTION(limits.memory_quota),
                 "Memory of messages in transit; as much again each for imports, exports, unread "
                 "answers and "
                 "beliefs; 0: no limit",
                 std::int64_t{16} << 20, std::int64_t{1} << 40, "bytes", true, true},
    ServerOption{"idle-stream-s", HOMING_OPTION(limits.idle_stream_s),
                 "A stream without traffic for this long is closed, s; 0: never", 0, 86'400, "s",
                 false, true},
    ServerOption{"keepalive-s", HOMING_OPTION(limits.keepalive_s),
                 "A connection without traffic for this long is probed, s", 1, 3600, "s", false,
                 true},
    ServerOption{"delete-after-s", HOMING_OPTION(limits.delete_after_s),
                 "Finished journeys created longer ago than this are deleted, s; 0: never", 0,
                 10'000'000'000, "s", false, true},
    ServerOption{"delete-oldest", HOMING_OPTION(limits.delete_oldest),
                 "At a robot's quota its oldest finished journeys are deleted"},
    ServerOption{"max-message", HOMING_OPTION(max_message), "Largest message, for example 16MiB",
                 65'536, kMaxMessage, "bytes", false, true},
    ServerOption{"max-pixels", HOMING_OPTION(max_pixels), "Largest frame, pixels", 256, kMaxMessage,
                 "px", false, true},
    ServerOption{"max-vectors", HOMING_OPTION(max_vectors),
                 "Most flow vectors of one camera at one instant", 1,
                 static_cast<std::int64_t>(kMaxFlowVectors), "vectors", false, true},
    ServerOption{"workers", HOMING_OPTION(workers), "Threads that compute; 0: one a core", 0, 1024,
                 "threads"},
    ServerOption{"max-connection-age-s", HOMING_OPTION(max_connection_age_s),
                 "Age at which a connection is closed, so that clients spread over several "
                 "servers, s; 0: never",
                 0, 86'400, "s"},
    ServerOption{"drain-ms", HOMING_OPTION(drain_ms), "Time for streams to end at shutdown, ms", 0,
                 600'000, "ms"},
    ServerOption{"map-cache", HOMING_OPTION(map_cache),
                 "Memory for maps, for example 1GiB; 0: no limit", 0, kMaxBytes, "bytes"},
    ServerOption{"all-journeys-index", HOMING_OPTION(all_journeys_index),
                 "Index all journeys, so that matching against all is as fast as against one"},
    ServerOption{"insecure", HOMING_OPTION(insecure), "Listen off loopback without TLS"},
    ServerOption{"readonly", HOMING_OPTION(readonly),
                 "Localise only; the database, which must have been closed cleanly, is not "
                 "changed"},
    ServerOption{"log-format", HOMING_OPTION(log_format),
                 "text, or json: an object a line, with the trace of the call"},
    ServerOption{"no-reflection", HOMING_OPTION(no_reflection),
                 "Do not describe the API to clients"},
};

#undef HOMING_OPTION

// The accessors take a mutable object; only its values are read here.
Value ValueOf(const ServerOption& option, const ServerOptions& options) {
  return option.value(const_cast<ServerOptions&>(options));
}

// REQUIRES: IsNumber(value).
std::int64_t NumberOf(const Value& value) {
  const auto* small = std::get_if<int*>(&value);
  return small != nullptr ? **small : *std::get<std::int64_t*>(value);
}

bool IsNumber(const Value& value) {
  return std::holds_alternative<int*>(value) || std::holds_alternative<std::int64_t*>(value);
}

// As --help shows it: a whole number of GiB or MiB as such, nothing for a flag.
std::string DefaultText(const ServerOption& option, const Value& value) {
  if (const auto* text = std::get_if<std::string*>(&value)) return **text;
  if (!IsNumber(value)) return "";
  const std::int64_t number = NumberOf(value);
  constexpr std::int64_t kMiB = std::int64_t{1} << 20;
  if (std::string(option.unit) != "bytes" || number == 0 || number % kMiB != 0) {
    return absl::StrCat(number);
  }
  const std::int64_t mebibytes = number / kMiB;
  return mebibytes % 1024 == 0 ? absl::StrCat(mebibytes / 1024, "GiB")
                               : absl::StrCat(mebibytes, "MiB");
}

std::string TomlValue(const Value& value) {
  if (const auto* text = std::get_if<std::string*>(&value)) {
    return absl::StrCat("\"", absl::CEscape(**text), "\"");
  }
  if (const auto* flag = std::get_if<bool*>(&value)) {
    return **flag ? "true" : "false";
  }
  return absl::StrCat(NumberOf(value));
}

}  // namespace

// A flag whose default is empty must not be given an empty text: with an unset variable in a script
// the server would start without tokens or certificates.
void AddServerOptions(CLI::App* app, ServerOptions* options) {
  for (const ServerOption& option : kOptions) {
    const std::string flag = absl::StrCat("--", option.name);
    const Value value = option.value(*options);
    CLI::Option* added = std::visit(
        [&](auto* member) {
          if constexpr (std::is_same_v<decltype(member), bool*>) {
            return app->add_flag(flag, *member, option.help);
          } else {
            return app->add_option(flag, *member, option.help);
          }
        },
        value);
    added->default_str(DefaultText(option, value));
    if (std::holds_alternative<std::string*>(value) && std::get<std::string*>(value)->empty()) {
      added->check(CLI::Validator(
          [](const std::string& text) { return text.empty() ? "must not be empty" : ""; }, ""));
    }
    added->envname("HOMING_" +
                   absl::AsciiStrToUpper(absl::StrReplaceAll(option.name, {{"-", "_"}})));
    if (std::string(option.unit) == "bytes") {
      added->transform(CLI::AsSizeValue(false));
    }
  }
}

absl::Status CheckRanges(const ServerOptions& options) {
  for (const ServerOption& option : kOptions) {
    const Value value = ValueOf(option, options);
    if (!IsNumber(value) || (option.zero_is_valid && NumberOf(value) == 0)) {
      continue;
    }
    HOMING_RETURN_IF_ERROR(
        CheckRange(option.name, NumberOf(value), option.low, option.high, option.unit));
  }
  return absl::OkStatus();
}

std::string ToToml(const ServerOptions& options) {
  std::string toml;
  for (const ServerOption& option : kOptions) {
    absl::StrAppend(&toml, option.name, " = ", TomlValue(ValueOf(option, options)), "\n");
  }
  return toml;
}

void ForEachLimit(const ServerOptions& options,
                  const std::function<void(const std::string& name, double value)>& set) {
  for (const ServerOption& option : kOptions) {
    if (option.is_limit) {
      set(option.name, static_cast<double>(NumberOf(ValueOf(option, options))));
    }
  }
}

}  // namespace homing::server
