// Options of homing-server: command line before environment (HOMING_*) before TOML file.
// Source: own design.
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
  // "sqlite:PATH".
  std::string database = "sqlite:homing.db";
  // PEM files; both or neither. With a client CA, clients must show a certificate of it.
  std::string tls_cert;
  std::string tls_key;
  std::string tls_client_ca;
  // Folder of revocation lists (PEM) of the client CA and its intermediates.
  std::string tls_crl_dir;
  // Files of bearer tokens (server/access/token_book.h) and of roles (role_book.h). With either, or
  // with a client CA, every caller must say who it is.
  std::string tokens;
  std::string roles;
  // How often these files are read again, s. [1, 3600].
  int reload_s = 5;
  // Where GET /metrics is answered, host and port; "off" or empty: nowhere.
  std::string http = "off";
  // Nobody asked for http: go on without it if the address cannot be had.
  bool http_optional = false;
  Limits limits;
  // Largest message taken, bytes. [64 KiB, 256 MiB].
  std::int64_t max_message = std::int64_t{16} << 20;
  // Largest frame, pixels. [256, 268'435'456].
  std::int64_t max_pixels = std::int64_t{16} << 20;
  // Most flow vectors of one camera at one instant. [1, 10'000'000].
  int max_vectors = 100'000;
  // Threads that compute; 0: one a core. [0, 1024].
  int workers = 0;
  // How long streams may take to end when the server is told to stop, ms. [0, 600'000].
  int drain_ms = 5000;
  // Maps in memory that no one uses are let go of beyond this, bytes; 0: no limit.
  // [0, 1 PiB].
  std::int64_t map_cache = std::int64_t{1} << 30;
  // Keep an index of all journeys' landmarks: 24 to 32 bytes a fingerprint.
  bool all_journeys_index = false;
  // Listen off loopback without TLS.
  bool insecure = false;
  // Localise only; no byte of the database is changed.
  bool readonly = false;
  // Do not describe the API to clients that ask.
  bool no_reflection = false;
};

inline bool HasHttp(const ServerOptions& options) {
  return !options.http.empty() && options.http != "off";
}

// INVALID_ARGUMENT naming field, value and limit; off loopback without TLS is one.
absl::Status Validate(const ServerOptions& options);

// As the TOML file would have it, a line a key.
std::string ToToml(const ServerOptions& options);

// A token to be made.
struct TokenOrder {
  std::string identity;
  // File for the token itself.
  std::string out;
};

// What the command line asks for.
struct ServerCommand {
  enum class Action { kServe, kCheckConfig, kHealthCheck, kDoctor, kBackup, kCerts, kToken, kExit };
  Action action = Action::kServe;
  ServerOptions options;
  // kHealthCheck: whom to ask, and the CA of its certificate (empty: no TLS).
  std::string health_server;
  std::string health_ca;
  // Instead of a CA: the very certificate of the server.
  std::string health_trusted;
  std::string health_cert;
  std::string health_key;
  // kDoctor, kBackup: the database file, and the new file to write (kDoctor: empty, nothing).
  std::string store_path;
  std::string target_path;
  CertificateOrder certificates;
  TokenOrder token;
  // kExit: what main returns (help and version were printed, or an error told).
  int exit_code = 0;
};

ServerCommand ParseCommandLine(int argc, const char* const* argv);

}  // namespace homing::server

#endif  // SERVER_CONFIG_SERVER_OPTIONS_H_
