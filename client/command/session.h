// What all commands share: the connection's flags, how to speak, when to stop. Source: own design.
#ifndef CLIENT_COMMAND_SESSION_H_
#define CLIENT_COMMAND_SESSION_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/camera_instants.h"
#include "client/connection.h"

namespace homing::client {

// Lives as long as the program.
struct Session {
  // What messages on stderr begin with.
  std::string program = "homing";
  ConnectionOptions connection;
  // One object a line on stdout, nothing else there.
  bool json = false;
  bool quiet = false;
  // Requested at SIGINT and SIGTERM.
  std::stop_token stop;
  // The chosen command; set while the command line is read, run afterwards.
  std::function<absl::Status()> run;

  // Connected, or UNAVAILABLE naming the address.
  absl::StatusOr<Connection> Connect() const;
  // To stderr, unless quiet. Thread-safe.
  void Log(const std::string& text) const;
  // The choice with what this command reports and stops at.
  FrameChoice WithReports(FrameChoice choice) const;
  // One line on stdout, out at once. FAILED_PRECONDITION: stdout is closed.
  absl::Status PrintJson(const nlohmann::ordered_json& line) const;
  absl::Status Print(const std::string& line) const;
};

// --server, --json, --tls-*, --retry-seconds, --quiet.
void AddCommonFlags(CLI::App& app, Session& session);

// 0 done, 1 the work failed, 3 server unreachable; the error is said on stderr.
int ExitCode(const Session& session, const absl::Status& status);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_SESSION_H_
