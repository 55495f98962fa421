#include <toml++/toml.h>
#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "server/config/option_groups.h"
#include "server/config/server_options.h"
#include "server/config/store_commands.h"

namespace homing::server {
namespace {

constexpr char kVersion[] = "0.1.0";
constexpr char kDefaultHttp[] = "127.0.0.1:8080";

void AddOptions(CLI::App* app, ServerOptions* options) {
  app->add_option("--listen", options->listen, "Address and port; port 0 picks one")
      ->envname("HOMING_LISTEN");
  app->add_option("--database", options->database, "sqlite:PATH")->envname("HOMING_DATABASE");
  app->add_option("--http", options->http, "Address of GET /metrics; \"off\": none")
      ->envname("HOMING_HTTP");
  AddAccessOptions(app, options);
  AddLimitOptions(app, &options->limits);
  app->add_option("--max-message", options->max_message, "Largest message, for example 16MiB")
      ->transform(CLI::AsSizeValue(false))
      ->envname("HOMING_MAX_MESSAGE");
  app->add_option("--max-pixels", options->max_pixels, "Largest frame, pixels")
      ->envname("HOMING_MAX_PIXELS");
  app->add_option("--max-vectors", options->max_vectors,
                  "Most flow vectors of one camera at one instant")
      ->envname("HOMING_MAX_VECTORS");
  app->add_option("--workers", options->workers, "Threads that compute; 0: one a core")
      ->envname("HOMING_WORKERS");
  app->add_option("--drain-ms", options->drain_ms, "Time for streams to end at shutdown, ms")
      ->envname("HOMING_DRAIN_MS");
  app->add_option("--map-cache", options->map_cache,
                  "Memory for maps that no one uses, for example 1GiB; 0: no limit")
      ->transform(CLI::AsSizeValue(false))
      ->envname("HOMING_MAP_CACHE");
  app->add_flag("--all-journeys-index", options->all_journeys_index,
                "Index all journeys, so that matching against all is as fast as against one")
      ->envname("HOMING_ALL_JOURNEYS_INDEX");
  app->add_flag("--insecure", options->insecure, "Listen off loopback without TLS")
      ->envname("HOMING_INSECURE");
  app->add_flag("--readonly", options->readonly,
                "Localise only; the database, which must have been closed well, is not changed")
      ->envname("HOMING_READONLY");
  app->add_flag("--no-reflection", options->no_reflection, "Do not describe the API to clients")
      ->envname("HOMING_NO_REFLECTION");
}

// A value of the file as it would stand on the command line.
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

// Gives the options that neither flag nor variable set the values of the file. Keys are the
// names of the flags.
void ApplyFile(const std::string& path, CLI::App* app) {
  const toml::table file = toml::parse_file(path);
  for (const auto& [key, node] : file) {
    const std::string name(key.str());
    CLI::Option* option = app->get_option_no_throw("--" + name);
    if (option == nullptr || name == "config" || name == "help" || name == "version" ||
        name == "check-config") {
      std::ostringstream message;
      message << path << ": unknown key \"" << name << '"';
      throw CLI::ValidationError("config", message.str());
    }
    if (option->count() == 0) {
      option->add_result(option->get_flag_value(option->get_single_name(), TextOf(node)));
      option->run_callback();
    }
  }
}

// The server of the same options and environment: its address and its certificate. A server that
// asks for certificates of its clients needs --cert and --key: one of `certs` is good for a server
// alone.
void ChooseHealthCheck(ServerCommand* command) {
  const ServerOptions& server = command->options;
  const bool own = command->health_server.empty();
  if (own) command->health_server = server.listen;
  if (!own || !command->health_ca.empty() || server.tls_cert.empty()) return;
  command->health_trusted = server.tls_cert;
}

int TellError(const std::string& message) {
  std::cerr << "homing-server: " << message << '\n';
  return 2;
}

}  // namespace

ServerCommand ParseCommandLine(int argc, const char* const* argv) {
  ServerCommand command;
  // Metrics are there unless refused; a port that is taken is then no reason not to serve.
  command.options.http = kDefaultHttp;
  CLI::App app("Localisation server for robots: records journeys and recognises the way home.",
               "homing-server");
  AddOptions(&app, &command.options);
  std::string config;
  bool check_config = false;
  app.add_option("--config", config, "TOML file; its keys are the names of these flags")
      ->check(CLI::ExistingFile)
      ->envname("HOMING_CONFIG");
  app.add_flag("--check-config", check_config, "Check options and end");
  app.set_version_flag("--version", std::string("homing-server ") + kVersion);
  CLI::App* health = app.add_subcommand("healthcheck", "Exit 0 if a server is serving, else 1");
  health->fallthrough();
  health->add_option("--server", command.health_server, "Address; by default that of --listen");
  health
      ->add_option("--ca", command.health_ca,
                   "CA of the server's certificate, PEM: use TLS; by default the certificate of "
                   "--tls-cert is trusted")
      ->envname("HOMING_HEALTH_CA");
  health->add_option("--cert", command.health_cert, "Certificate to show, PEM")
      ->envname("HOMING_HEALTH_CERT");
  health->add_option("--key", command.health_key, "Its private key, PEM")
      ->envname("HOMING_HEALTH_KEY");
  const StoreCommands store(&app, &command);
  CLI::App* certs = AddCertsCommand(&app, &command.certificates);
  CLI::App* token = AddTokenCommand(&app, &command.token);
  try {
    app.parse(argc, argv);
    if (!config.empty()) {
      ApplyFile(config, &app);
    }
  } catch (const CLI::ParseError& error) {
    const bool told = error.get_exit_code() == 0;
    command.action = ServerCommand::Action::kExit;
    command.exit_code = told ? app.exit(error) : TellError(error.what());
    return command;
  } catch (const toml::parse_error& error) {
    command.action = ServerCommand::Action::kExit;
    command.exit_code = TellError(config + ": " + std::string(error.description()));
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
