// Options of homing-server. The command line comes before the environment (HOMING_*), which comes
// before the TOML file. Flags and ranges are in option_table.cc.
#ifndef SERVER_CONFIG_SERVER_OPTIONS_H_
#define SERVER_CONFIG_SERVER_OPTIONS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/access/certificate_folder.h"
#include "server/admission/limits.h"

namespace homing::server {

struct ServerOptions {
  // Host and port; port 0 picks one.
  std::string listen = "127.0.0.1:50551";
  // "sqlite:PATH", or "postgresql://..." for several servers.
  std::string database = "sqlite:homing.db";
  // PEM files; both or neither. With a client CA, clients must show a certificate signed by it.
  std::string tls_cert;
  std::string tls_key;
  std::string tls_client_ca;
  // Folder of revocation lists (PEM) of the client CA and its intermediates.
  std::string tls_crl_dir;
  // Files of bearer tokens (server/access/token_book.h) and of roles (role_book.h). With either, or
  // with a client CA, every caller needs credentials.
  std::string tokens;
  std::string roles;
  // Interval at which these files are read again, s.
  int reload_s = 5;
  // Address of the console and of GET /metrics, host and port; "off" or empty: none. With tls_cert
  // it speaks TLS.
  std::string http = "off";
  // `http` is not set but has its default: the server starts without it if the address is not
  // available.
  bool http_optional = false;
  // Names, separated by commas, by which browsers reach the console; "localhost" and addresses need
  // not be listed.
  std::string http_host;
  // The header in which a proxy names its user: "operators/USER". Only the proxy may reach `http`
  // then.
  std::string http_user_header;
  Limits limits;
  // Largest message accepted, bytes.
  std::int64_t max_message = std::int64_t{16} << 20;
  // Largest frame, pixels.
  std::int64_t max_pixels = std::int64_t{16} << 20;
  // Most flow vectors of one camera at one instant.
  int max_vectors = 100'000;
  // Threads that compute; 0: one a core.
  int workers = 0;
  // Age at which a connection is closed, with 10 s for its streams, so that clients spread over the
  // servers again, s. 0: never.
  int max_connection_age_s = 0;
  // Time for streams to end at shutdown, ms.
  int drain_ms = 5000;
  // Map-cache limit, bytes (CatalogOptions::cache_bytes).
  std::int64_t map_cache = std::int64_t{1} << 30;
  // Keep an index of all journeys' landmarks: 24 to 32 bytes a fingerprint.
  bool all_journeys_index = false;
  // Listen off loopback without TLS.
  bool insecure = false;
  // Localise only; no byte of the database is changed.
  bool readonly = false;
  // Lines of the log: "text" or "json".
  std::string log_format = "text";
  // Do not describe the API to clients that ask.
  bool no_reflection = false;
};

inline bool HasHttp(const ServerOptions& options) {
  return !options.http.empty() && options.http != "off";
}

// True if every caller that reaches the server may do everything: it is not on loopback, and asks
// for neither tokens nor certificates.
bool IsOpenToAll(const ServerOptions& options);
// INVALID_ARGUMENT naming the field and the rule that it breaks.
absl::Status Validate(const ServerOptions& options);

// Order for a new token.
struct TokenOrder {
  std::string identity;
  // File for the token itself.
  std::string out;
};

// The parsed command line.
struct ServerCommand {
  enum class Action { kServe, kCheckConfig, kHealthCheck, kDoctor, kBackup, kCerts, kToken, kExit };
  Action action = Action::kServe;
  ServerOptions options;
  // kHealthCheck: the address, and the CA of its certificate (empty: no TLS).
  std::string health_server;
  std::string health_ca;
  // Instead of a CA: the server's certificate itself.
  std::string health_trusted;
  std::string health_cert;
  std::string health_key;
  // kDoctor, kBackup: the database file, and the new file to write (kDoctor: empty for none).
  std::string store_path;
  std::string target_path;
  CertificateOrder certificates;
  TokenOrder token;
  // kExit: the exit code of main, after help, version or an error was printed.
  int exit_code = 0;
};

ServerCommand ParseCommandLine(int argc, const char* const* argv);

}  // namespace homing::server

#endif  // SERVER_CONFIG_SERVER_OPTIONS_H_
