#include "client/command/drive_output.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/json_line.h"
#include "client/file/output_file.h"
#include "client/picture/drive_picture.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

const char* Word(Pilot::State state) {
  switch (state) {
    case Pilot::State::kTurningRound:
      return "TURNING_ROUND";
    case Pilot::State::kDriving:
      return "DRIVING";
    case Pilot::State::kSearching:
      return "SEARCHING";
    case Pilot::State::kWaiting:
      return "WAITING";
    case Pilot::State::kHome:
      break;
  }
  return "HOME";
}

const char* Word(PilotAnswer::Outcome outcome) {
  switch (outcome) {
    case PilotAnswer::Outcome::kMatch:
      return "MATCH";
    case PilotAnswer::Outcome::kAmbiguous:
      return "AMBIGUOUS";
    case PilotAnswer::Outcome::kUnknownPlace:
      break;
  }
  return "UNKNOWN_PLACE";
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json ToJson(const DrivenPoint& point) {
  const PilotAnswer answer = point.answer.value_or(PilotAnswer{});
  return {{"time", point.time_s},
          {"x", point.pose.position[0]},
          {"y", point.pose.position[1]},
          {"route", point.route_m},
          {"left", point.left_m},
          {"heading", point.heading},
          {"state", Word(point.state)},
          {"speed", point.command.speed_mps},
          {"turn_rate", point.command.turn_rate},
          {"outcome", point.answer ? Json(Word(answer.outcome)) : Json()},
          {"probability", point.answer ? Json(answer.probability) : Json()},
          {"progress_home", OrNull(answer.progress_home)},
          {"turn", OrNull(answer.turn)},
          {"path_offset", OrNull(answer.path_offset)}};
}

struct Figures {
  double end_m = 0;
  double median_m = 0;
  double most_m = 0;
};

Figures FiguresOf(const HomeDrive& drive, const Route& route) {
  std::vector<double> beside;
  for (const DrivenPoint& point : drive.points) beside.push_back(std::abs(point.left_m));
  std::ranges::sort(beside);
  if (beside.empty()) return {};
  return {drive.EndFromHome(route), beside[beside.size() / 2], beside.back()};
}

DrivePicture PictureOf(const HomeDrive& drive, const Route& route, double route_m,
                       const std::string& title) {
  DrivePicture picture{.title = title, .outbound = {}, .driven = {}};
  for (double at = 0; at <= route_m; at += 0.5) {
    const Vector2 place = route.At(at).position;
    picture.outbound.push_back({place[0], place[1]});
  }
  for (const DrivenPoint& point : drive.points) {
    if (point.state == Pilot::State::kTurningRound) continue;
    picture.driven.push_back({.place = {point.pose.position[0], point.pose.position[1]},
                              .route_m = point.route_m,
                              .left_m = point.left_m,
                              .heading_deg = point.heading / kDegree,
                              .outcome = point.answer
                                             ? static_cast<DrivePicture::Outcome>(
                                                   1 + static_cast<int>(point.answer->outcome))
                                             : DrivePicture::Outcome::kNone});
  }
  return picture;
}

absl::Status WriteFiles(const HomeDrive& drive, const DrivePicture& picture,
                        const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return absl::PermissionDeniedError(absl::StrCat("cannot make ", folder, ": ", error.message()));
  }
  HOMING_RETURN_IF_ERROR(DrawDrive(absl::StrCat(folder, "/drive.png"), picture));
  return WriteOutputFile(absl::StrCat(folder, "/drive.csv"),
                         [&](std::ostream& file) {
                           file << "time,x,y,route,left,heading,state,outcome\n";
                           for (const DrivenPoint& p : drive.points) {
                             file << absl::StrFormat(
                                 "%.2f,%.3f,%.3f,%.3f,%.3f,%.4f,%s,%s\n", p.time_s,
                                 p.pose.position[0], p.pose.position[1], p.route_m, p.left_m,
                                 p.heading, Word(p.state), p.answer ? Word(p.answer->outcome) : "");
                           }
                           return absl::OkStatus();
                         })
      .status();
}

}  // namespace

absl::Status ReportDrive(const Session& session, const HomeDrive& drive, const Route& route,
                         double route_m, const std::string& folder) {
  const Figures figures = FiguresOf(drive, route);
  const bool came_home = drive.stopped && figures.end_m <= kAtHomeM;
  const std::string verdict = absl::StrFormat(
      "%s: stopped %.2f m from home; %.2f m beside the way out in the median, %.2f m at most",
      came_home ? "came home" : "NOT HOME", figures.end_m, figures.median_m, figures.most_m);
  if (!folder.empty()) {
    HOMING_RETURN_IF_ERROR(WriteFiles(drive, PictureOf(drive, route, route_m, verdict), folder));
  }
  if (session.json) {
    for (const DrivenPoint& point : drive.points) {
      HOMING_RETURN_IF_ERROR(session.PrintJson(ToJson(point)));
    }
    HOMING_RETURN_IF_ERROR(session.PrintJson(Json{{"came_home", came_home},
                                                  {"end_from_home", figures.end_m},
                                                  {"median_beside", figures.median_m},
                                                  {"most_beside", figures.most_m}}));
  } else {
    HOMING_RETURN_IF_ERROR(session.Print(verdict));
  }
  return came_home ? absl::OkStatus() : absl::AbortedError("the robot did not come home");
}

}  // namespace homing::client
