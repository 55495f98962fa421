#include "client/command/session.h"

#include <cstdio>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/command/real_range.h"
#include "client/command/shown_text.h"
#include "client/rpc_status.h"
#include "client/server_address.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// How the user can react to a refusal by the server.
std::string AdviceOn(const absl::Status& status) {
  if (!IsFromServer(status)) return "";
  if (absl::IsUnauthenticated(status)) {
    return "give credentials: --tls-cert and --tls-key, or --token-file";
  }
  if (absl::IsPermissionDenied(status)) {
    return "the server's operator can change roles, or list this robot among a journey's readers";
  }
  if (absl::IsAlreadyExists(status)) {
    return "give another name; homing journeys delete removes a journey";
  }
  if (absl::IsUnimplemented(status)) return "the server is older than this program";
  if (IsReset(status)) {
    return "a proxy in between closed the stream, perhaps after so many bytes: for nginx, "
           "client_max_body_size 0";
  }
  if (absl::IsResourceExhausted(status) && absl::StrContains(status.message(), "larger than max")) {
    return "a message was too large: --send flow sends far less, and the server takes more with "
           "--max-message";
  }
  return "";
}

}  // namespace

absl::StatusOr<Connection> Session::Connect() const {
  HOMING_ASSIGN_OR_RETURN(Connection opened, Connection::Open(connection));
  HOMING_RETURN_IF_ERROR(opened.WaitForServer());
  return opened;
}

void Session::Log(const std::string& text) const {
  if (!quiet) std::fputs(absl::StrCat(program, ": ", ShownText(text), "\n").c_str(), stderr);
}

FrameChoice Session::WithReports(FrameChoice choice) const {
  choice.report = [this](const std::string& text) { Log(text); };
  choice.stop = stop;
  return choice;
}

absl::Status Session::Print(const std::string& line) const {
  std::fputs((ShownText(line) + "\n").c_str(), stdout);
  if (std::fflush(stdout) != 0) {
    return absl::FailedPreconditionError("cannot write to standard output");
  }
  return absl::OkStatus();
}

absl::Status Session::PrintJson(const nlohmann::ordered_json& line) const {
  // Invalid UTF-8 in a name must not throw.
  return Print(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void AddCommonFlags(CLI::App& app, Session& session) {
  ConnectionOptions& connection = session.connection;
  app.add_option("--server", connection.address,
                 "Address of homing-server, HOST:PORT; several with commas, or dns:///NAME:PORT")
      ->capture_default_str()
      ->check([](const std::string& text) {  // CLI11 names the flag itself.
        const std::string wrong(CheckServerAddress(text).message());
        return std::string(absl::StripPrefix(wrong, "--server: "));
      })
      ->envname("HOMING_SERVER");
  app.add_flag("--json", session.json, "One JSON object a line on stdout, nothing else there");
  app.add_flag("--quiet,-q", session.quiet, "Print only errors on stderr");
  app.add_option("--tls-ca", connection.tls_ca, "TLS: PEM file of the certificates to trust");
  app.add_option("--tls-cert", connection.tls_cert, "TLS: PEM file of this robot's certificate");
  app.add_option("--tls-key", connection.tls_key, "TLS: PEM file of this robot's key");
  app.add_option("--token-file", connection.token_file, "File of this robot's token")
      ->envname("HOMING_TOKEN_FILE");
  app.add_option("--traceparent", connection.traceparent,
                 "W3C trace that the calls belong to; otherwise a new one")
      ->envname("TRACEPARENT");
  app.add_flag("--insecure", connection.insecure,
               "Allow the token to leave this machine in plain text");
  app.add_option_function<double>(
         "--retry-seconds",
         [&connection](const double& seconds) {
           connection.retry_for =
               std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
         },
         "How long to retry a broken connection, seconds [60]")
      ->check(RealRange(0.0, 1e6));
}

int ExitCode(const Session& session, const absl::Status& status) {
  if (status.ok()) return 0;
  const std::string code = absl::StatusCodeToString(status.code());
  std::fputs(absl::StrCat(session.program, ": error: ", ShownText(std::string(status.message())),
                          " (", code, ")\n")
                 .c_str(),
             stderr);
  if (const std::string advice = AdviceOn(status); !advice.empty()) {
    std::fputs(absl::StrCat(session.program, ": ", advice, "\n").c_str(), stderr);
  }
  if (!absl::IsUnavailable(status)) return 1;
  const std::string& address = session.connection.address;
  if (std::string(status.message()).find(address) == std::string::npos) {
    std::fputs(absl::StrCat(session.program, ": server ", address, " is unreachable\n").c_str(),
               stderr);
  }
  return 3;
}

}  // namespace homing::client
