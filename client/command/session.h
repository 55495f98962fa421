// The state that all commands share: connection flags, output, and the stop signal.
#ifndef CLIENT_COMMAND_SESSION_H_
#define CLIENT_COMMAND_SESSION_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/source/camera_instants.h"

namespace homing::client {

// Lives as long as the program.
struct Session {
  // The prefix of messages on stderr.
  std::string program = "homing";
  ConnectionOptions connection;
  // Print one JSON object a line on stdout, and nothing else there.
  bool json = false;
  bool quiet = false;
  // Set by SIGINT and SIGTERM.
  std::stop_token stop;
  // The chosen command; set while the command line is parsed, run afterwards.
  std::function<absl::Status()> run;

  // A connection to a server that answers, or UNAVAILABLE with the address.
  absl::StatusOr<Connection> Connect() const;
  // To stderr, unless quiet. Thread-safe.
  void Log(const std::string& text) const;
  // Adds this command's log and stop signal to the choice.
  FrameChoice WithReports(FrameChoice choice) const;
  // Writes and flushes one line on stdout, as ShownText. FAILED_PRECONDITION: stdout is closed.
  absl::Status PrintJson(const nlohmann::ordered_json& line) const;
  absl::Status Print(const std::string& line) const;
};

// --server, --json, --tls-*, --retry-seconds, --quiet.
void AddCommonFlags(CLI::App& app, Session& session);

// Prints the error on stderr. 0: done, 1: the work failed, 3: the server is unreachable.
int ExitCode(const Session& session, const absl::Status& status);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_SESSION_H_
