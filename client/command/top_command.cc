#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/command/commands.h"
#include "client/command/json_line.h"
#include "client/fleet_client.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// The most urgent first.
enum class State { kLost, kAmbiguous, kRecording, kOnRoute, kOffline };

State StateOf(const v1::Robot& robot) {
  if (robot.activity() == v1::ACTIVITY_RECORDING) return State::kRecording;
  if (robot.activity() != v1::ACTIVITY_LOCALIZING) return State::kOffline;
  if (robot.has_lost_since()) return State::kLost;
  return robot.answer().outcome() == v1::OUTCOME_MATCH ? State::kOnRoute : State::kAmbiguous;
}

const char* WordOf(State state) {
  constexpr const char* kWords[] = {"LOST", "AMBIGUOUS", "RECORDING", "ON_ROUTE", "OFFLINE"};
  return kWords[static_cast<std::size_t>(state)];
}

std::string Ago(const v1::Robot& robot) {
  if (!robot.has_last_seen()) return "-";
  const std::int64_t now = absl::ToUnixSeconds(absl::Now());
  return absl::StrCat(std::max<std::int64_t>(0, now - robot.last_seen().seconds()), " s");
}

std::string RobotRow(const v1::Robot& robot) {
  const v1::LocalizeResponse& answer = robot.answer();
  const State state = StateOf(robot);
  const bool localizes = robot.activity() == v1::ACTIVITY_LOCALIZING;
  return absl::StrFormat("%-24s  %-9s  %-36s  %6s  %6s  %8s  %8d", robot.name(), WordOf(state),
                         robot.journey(),
                         localizes && answer.has_progress_home()
                             ? absl::StrFormat("%3.0f %%", 100 * answer.progress_home())
                             : "-",
                         localizes ? absl::StrFormat("%.2f", answer.probability()) : "-",
                         Ago(robot), robot.journey_count());
}

Json RobotJson(const v1::Robot& robot) {
  Json line = {{"robot", robot.name()},
               {"state", WordOf(StateOf(robot))},
               {"journey", robot.journey()},
               {"journeys", robot.journey_count()},
               {"observations", robot.observation_count()}};
  line["probability"] = robot.has_answer() ? Json(robot.answer().probability()) : Json();
  line["step"] = robot.answer().has_step() ? Json(robot.answer().step()) : Json();
  line["progress_home"] =
      robot.answer().has_progress_home() ? Json(robot.answer().progress_home()) : Json();
  line["last_seen"] = robot.has_last_seen() ? Json(robot.last_seen().seconds()) : Json();
  return line;
}

absl::Status PrintRobots(const Session& session, std::vector<v1::Robot> robots) {
  std::stable_sort(robots.begin(), robots.end(),
                   [](const v1::Robot& a, const v1::Robot& b) { return StateOf(a) < StateOf(b); });
  HOMING_RETURN_IF_ERROR(
      session.Print(absl::StrFormat("%-24s  %-9s  %-36s  %6s  %6s  %8s  %8s", "robot", "state",
                                    "journey", "home", "prob.", "seen", "journeys")));
  for (const v1::Robot& robot : robots) HOMING_RETURN_IF_ERROR(session.Print(RobotRow(robot)));
  return absl::OkStatus();
}

absl::Status Once(const Session& session) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  HOMING_ASSIGN_OR_RETURN(const std::vector<v1::Robot> robots,
                          ListRobots(connection, session.stop));
  if (!session.json) return PrintRobots(session, robots);
  for (const v1::Robot& robot : robots) HOMING_RETURN_IF_ERROR(session.PrintJson(RobotJson(robot)));
  return absl::OkStatus();
}

absl::Status Follow(const Session& session) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  std::map<std::string, v1::Robot> robots;
  const absl::Status status =
      WatchFleet(connection, session.stop, [&](const v1::WatchFleetResponse& changed) {
        for (const v1::Robot& robot : changed.robots()) {
          if (session.json) HOMING_RETURN_IF_ERROR(session.PrintJson(RobotJson(robot)));
          robots[robot.name()] = robot;
        }
        if (session.json) return absl::OkStatus();
        std::vector<v1::Robot> all;
        all.reserve(robots.size());
        for (const auto& [name, robot] : robots) all.push_back(robot);
        // Cursor home, then clear below: the table replaces the previous one.
        std::fputs("\x1b[H\x1b[J", stdout);
        return PrintRobots(session, std::move(all));
      });
  return session.stop.stop_requested() ? absl::OkStatus() : status;
}

}  // namespace

void AddTopCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "top", "Show the robots and their activity, lost ones first, as it changes");
  auto once = std::make_shared<bool>(false);
  command.add_flag(
      "--once", *once,
      "Print the present state and end; the default where stdout is not a terminal, unless --json");
  command.callback([once, &session] {
    session.run = [once, &session] {
      const bool follow = !*once && (session.json || ::isatty(STDOUT_FILENO) == 1);
      return follow ? Follow(session) : Once(session);
    };
  });
}

}  // namespace homing::client
