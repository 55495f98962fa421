#include "server/config/option_groups.h"

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace homing::server {
namespace {

// "--max-streams" is also HOMING_MAX_STREAMS.
template <typename T>
CLI::Option* Add(CLI::App* app, const std::string& name, T* value, const std::string& help) {
  const std::string variable =
      "HOMING_" + absl::AsciiStrToUpper(absl::StrReplaceAll(name, {{"-", "_"}}));
  return app->add_option("--" + name, *value, help)->envname(variable);
}

CLI::Option* AddSize(CLI::App* app, const std::string& name, std::int64_t* value,
                     const std::string& help) {
  return Add(app, name, value, help)->transform(CLI::AsSizeValue(false));
}

std::string Text(const char* key, const std::string& value) {
  return absl::StrCat(key, " = \"", absl::CEscape(value), "\"\n");
}

std::string Number(const char* key, std::int64_t value) {
  return absl::StrCat(key, " = ", value, "\n");
}

}  // namespace

void AddAccessOptions(CLI::App* app, ServerOptions* options) {
  Add(app, "tls-cert", &options->tls_cert, "Certificate chain, PEM");
  Add(app, "tls-key", &options->tls_key, "Its private key, PEM");
  Add(app, "tls-client-ca", &options->tls_client_ca,
      "Clients must show a certificate of this CA, PEM; its URI:homing:robots/ID is who they are");
  Add(app, "tls-crl-dir", &options->tls_crl_dir,
      "Folder of revocation lists, PEM; one of each issuer is required");
  Add(app, "tokens", &options->tokens, "File of bearer tokens, as `homing-server token` makes it");
  Add(app, "roles", &options->roles, "File of roles: [roles] \"robots/ID\" = \"localise-only\"");
  Add(app, "reload-s", &options->reload_s,
      "How often certificates, tokens and roles are read again, s");
}

void AddLimitOptions(CLI::App* app, Limits* limits) {
  Add(app, "max-streams", &limits->max_streams, "Open streams; 0: no limit, as below");
  Add(app, "max-robot-streams", &limits->max_robot_streams, "Open streams of one robot");
  Add(app, "max-robot-rate", &limits->max_robot_rate, "Observations of one robot a second");
  Add(app, "max-robot-journeys", &limits->max_robot_journeys, "Journeys kept of one robot");
  AddSize(app, "max-robot-bytes", &limits->max_robot_bytes, "Bytes kept of one robot");
  AddSize(app, "max-database", &limits->max_database, "Size of the database");
  AddSize(app, "memory-quota", &limits->memory_quota, "Memory for messages under way");
  Add(app, "idle-stream-s", &limits->idle_stream_s, "A stream silent for so long is closed, s");
  Add(app, "keepalive-s", &limits->keepalive_s, "A connection silent for so long is probed, s");
  Add(app, "delete-after-s", &limits->delete_after_s,
      "Finished journeys older than this are deleted, s; 0: never");
  app->add_flag("--delete-oldest", limits->delete_oldest,
                "At a robot's quota its oldest finished journeys are deleted")
      ->envname("HOMING_DELETE_OLDEST");
}

CLI::App* AddCertsCommand(CLI::App* app, CertificateOrder* order) {
  CLI::App* certs = app->add_subcommand(
      "certs", "Make a certificate authority, the server's certificate and robots'");
  certs->add_option("--out", order->folder, "Folder; an authority in it is used again")->required();
  certs->add_option("--robot", order->robots, "Id of a robot; may be repeated");
  certs->add_option("--operator", order->operators, "Id of an operator; may be repeated");
  certs->add_option("--host", order->hosts, "Name or address of the server; may be repeated");
  certs->add_option("--revoke", order->revoked, "robots/ID or operators/ID; may be repeated");
  certs->add_option("--days", order->days, "How long they are good")->capture_default_str();
  return certs;
}

CLI::App* AddTokenCommand(CLI::App* app, TokenOrder* order) {
  CLI::App* token = app->add_subcommand(
      "token", "Make a token: its hash goes into the file of --tokens, the token into --out");
  token->fallthrough();
  token->add_option("identity", order->identity, "robots/ID or operators/ID")->required();
  token->add_option("--out", order->out, "File for the token, for the robot")->required();
  return token;
}

std::string AccessToToml(const ServerOptions& options) {
  return Text("tls-cert", options.tls_cert) + Text("tls-key", options.tls_key) +
         Text("tls-client-ca", options.tls_client_ca) + Text("tls-crl-dir", options.tls_crl_dir) +
         Text("tokens", options.tokens) + Text("roles", options.roles) +
         Number("reload-s", options.reload_s);
}

std::string LimitsToToml(const Limits& limits) {
  return Number("max-streams", limits.max_streams) +
         Number("max-robot-streams", limits.max_robot_streams) +
         Number("max-robot-rate", limits.max_robot_rate) +
         Number("max-robot-journeys", limits.max_robot_journeys) +
         Number("max-robot-bytes", limits.max_robot_bytes) +
         Number("max-database", limits.max_database) + Number("memory-quota", limits.memory_quota) +
         Number("idle-stream-s", limits.idle_stream_s) + Number("keepalive-s", limits.keepalive_s) +
         Number("delete-after-s", limits.delete_after_s) +
         absl::StrCat("delete-oldest = ", limits.delete_oldest ? "true" : "false", "\n");
}

}  // namespace homing::server
