// ParseCommandLine of server_options.h.
#include <toml++/toml.h>
#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/documentation_flag.h"
#include "cli/examples.h"
#include "server/config/option_table.h"
#include "server/config/server_options.h"
#include "server/config/store_commands.h"

namespace homing::server {
namespace {

constexpr char kDefaultHttp[] = "127.0.0.1:8080";

constexpr Example kExamples[] = {
    {"", "homing-server --database sqlite:homing.db"},
    {"", "homing-server --config /etc/homing/server.toml --check-config"},
    {"healthcheck", "homing-server healthcheck --server 127.0.0.1:50551"},
    {"doctor", "homing-server doctor homing.db --salvage salvaged.db"},
    {"backup", "homing-server backup --database sqlite:homing.db copy.db"},
    {"certs", "homing-server certs --out pki --host base.example.org --robot r1 --operator anna"},
    {"token", "homing-server token robots/r1 --tokens tokens --out r1.token"},
};

ManPage Page() {
  ManPage page;
  page.section = 8;
  page.version = "homing-server " HOMING_VERSION;
  page.exit_status = {"0: The server ended after SIGTERM or SIGINT, or the work is done.",
                      "1: The work failed.",
                      "2: The command line or the file of options is wrong."};
  page.files = {
      "/etc/homing/server.toml: Options of the service; the keys are the names of the flags.",
      "/etc/default/homing-server: Variables of the service.",
      "/var/lib/homing/homing.db: The database of the service."};
  page.see_also = {"homing(1)"};
  return page;
}

CLI::App* AddCertsCommand(CLI::App* app, CertificateOrder* order) {
  CLI::App* certs = app->add_subcommand(
      "certs",
      "Make a certificate authority, and certificates of the server, robots and operators");
  certs->add_option("--out", order->folder, "Folder; an authority in it is used again")->required();
  certs->add_option("--robot", order->robots, "Id of a robot; may be repeated");
  certs->add_option("--operator", order->operators, "Id of an operator; may be repeated");
  certs->add_option("--host", order->hosts, "Name or address of the server; may be repeated");
  certs->add_option("--revoke", order->revoked, "robots/ID or operators/ID; may be repeated");
  certs->add_option("--days", order->days, "Days that certificates are valid")
      ->capture_default_str();
  certs
      ->add_option("--ca-days", order->ca_days,
                   "Days that the authority and the revocation list are valid")
      ->capture_default_str();
  certs->add_flag("--renew-ca", order->renew_ca,
                  "Give the authority a new certificate; those it signed stay valid");
  return certs;
}

CLI::App* AddTokenCommand(CLI::App* app, TokenOrder* order) {
  CLI::App* token = app->add_subcommand(
      "token", "Make a token: its hash goes into the file of --tokens, the token into --out");
  token->fallthrough();
  token->add_option("identity", order->identity, "robots/ID or operators/ID")->required();
  token->add_option("--out", order->out, "File to write the token to; give it to the robot")
      ->required();
  return token;
}

// Converts a value of the file to the text that a flag would have.
std::string TextOf(const toml::node& node) {
  if (const auto text = node.value<std::string>(); text && node.is_string()) {
    return *text;
  }
  if (node.is_boolean()) {
    return node.value_or(false) ? "true" : "false";
  }
  if (const auto number = node.value<std::int64_t>(); number && node.is_integer()) {
    return std::to_string(*number);
  }
  throw CLI::ValidationError("config", "a value must be a string, an integer or a boolean");
}

// Sets the options that neither a flag nor a variable set from the file. Its keys are the names of
// the flags.
void ApplyFile(const std::string& path, CLI::App* app) {
  const toml::table file = toml::parse_file(path);
  for (const auto& [key, node] : file) {
    const std::string name(key.str());
    CLI::Option* option = app->get_option_no_throw("--" + name);
    if (option == nullptr || name == "config" || name == "help" || name == "version" ||
        name == "check-config" || name == "documentation") {
      std::ostringstream message;
      message << path << ": unknown key \"" << name << '"';
      throw CLI::ValidationError("config", message.str());
    }
    // --check-config prints an option that is off as an empty text.
    const bool is_off = node.value<std::string>() == "" && option->get_default_str().empty();
    if (option->count() == 0 && !is_off) {
      option->add_result(option->get_flag_value(option->get_single_name(), TextOf(node)));
      option->run_callback();
    }
  }
}

CLI::App* AddHealthCheck(CLI::App* app, ServerCommand* command) {
  CLI::App* health = app->add_subcommand("healthcheck", "Exit 0 if a server is serving, else 1");
  health->fallthrough();
  health->add_option("--server", command->health_server,
                     "Address of the server; by default that of --listen");
  health
      ->add_option("--ca", command->health_ca,
                   "CA of the server's certificate, PEM: use TLS; by default the certificate of "
                   "--tls-cert is trusted")
      ->envname("HOMING_HEALTH_CA");
  health->add_option("--cert", command->health_cert, "Certificate to show, PEM")
      ->envname("HOMING_HEALTH_CERT");
  health->add_option("--key", command->health_key, "Its private key, PEM")
      ->envname("HOMING_HEALTH_KEY");
  return health;
}

// Sets the address and the trusted certificate from the server's own options and environment. A
// server that requires client certificates needs --cert and --key too, because the server's
// certificate from `certs` is not valid for a client.
void ChooseHealthCheck(ServerCommand* command) {
  const ServerOptions& server = command->options;
  const bool own = command->health_server.empty();
  if (own) command->health_server = server.listen;
  if (!own || !command->health_ca.empty() || server.tls_cert.empty()) return;
  command->health_trusted = server.tls_cert;
}

int ReportError(const std::string& message) {
  std::cerr << "homing-server: " << message << '\n';
  return 2;
}

}  // namespace

ServerCommand ParseCommandLine(int argc, const char* const* argv) {
  ServerCommand command;
  // The console is on by default; then a port that is in use must not stop the server.
  command.options.http = kDefaultHttp;
  CLI::App app("Localisation server for robots: records journeys and recognises the way home.",
               "homing-server");
  AddServerOptions(&app, &command.options);
  std::string config;
  bool check_config = false;
  app.add_option("--config", config, "TOML file; its keys are the names of these flags")
      ->check(CLI::ExistingFile)
      ->envname("HOMING_CONFIG");
  app.add_flag("--check-config", check_config,
               "Check the options, print the values that the server would use, and end");
  app.set_version_flag("--version", "homing-server " HOMING_VERSION);
  CLI::App* health = AddHealthCheck(&app, &command);
  const StoreCommands store(&app, &command);
  CLI::App* certs = AddCertsCommand(&app, &command.certificates);
  CLI::App* token = AddTokenCommand(&app, &command.token);
  AddExamples(app, kExamples);
  AddDocumentationFlag(app, Page());
  try {
    app.parse(argc, argv);
    if (!config.empty()) {
      ApplyFile(config, &app);
    }
  } catch (const CLI::ParseError& error) {
    const bool printed = error.get_exit_code() == 0;
    command.action = ServerCommand::Action::kExit;
    command.exit_code = printed ? app.exit(error) : ReportError(error.what());
    return command;
  } catch (const toml::parse_error& error) {
    command.action = ServerCommand::Action::kExit;
    command.exit_code = ReportError(config + ": " + std::string(error.description()));
    return command;
  }
  command.options.http_optional = app.get_option("--http")->count() == 0;
  if (certs->parsed()) {
    command.action = ServerCommand::Action::kCerts;
  } else if (token->parsed()) {
    command.action = ServerCommand::Action::kToken;
  } else if (health->parsed()) {
    command.action = ServerCommand::Action::kHealthCheck;
    ChooseHealthCheck(&command);
  } else if (store.Choose(&command)) {
    return command;
  } else if (check_config) {
    command.action = ServerCommand::Action::kCheckConfig;
  }
  return command;
}

}  // namespace homing::server
