#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/json_line.h"
#include "client/file/output_file.h"
#include "client/journey_client.h"
#include "client/map_quality.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

struct JourneysFlags {
  std::string parent = "robots/-";
  std::string journey;
  std::string file;
  std::vector<std::string> readers;
  bool force = false;
  bool aliasing = false;
  int tolerance = 10;
};

std::string JourneyRow(const v1::Journey& journey) {
  return absl::StrFormat("%-40s  %-8s  %8d  %9d  %12d", journey.name(), Word(journey.state()),
                         journey.step_count(), journey.landmark_count(),
                         journey.fingerprint_count());
}

std::string JourneyHeader() {
  return absl::StrFormat("%-40s  %-8s  %8s  %9s  %12s", "journey", "state", "steps", "landmarks",
                         "fingerprints");
}

absl::Status List(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  if (!session.json) HOMING_RETURN_IF_ERROR(session.Print(JourneyHeader()));
  return JourneyClient(&connection, session.stop)
      .List(flags.parent, [&](const v1::Journey& journey) {
        return session.json ? session.PrintJson(ToJson(journey))
                            : session.Print(JourneyRow(journey));
      });
}

absl::Status ShowTable(const Session& session, const v1::Journey& journey,
                       const v1::DescribeRouteResponse& route,
                       const std::vector<v1::Landmark>& landmarks) {
  HOMING_RETURN_IF_ERROR(session.Print(JourneyHeader()));
  HOMING_RETURN_IF_ERROR(session.Print(JourneyRow(journey)));
  HOMING_RETURN_IF_ERROR(session.Print(MapQuality(journey).Text()));
  std::string cameras;
  for (const v1::RouteSide& side : route.sides()) {
    absl::StrAppend(&cameras, Word(side.side()), " looks ", Word(side.direction()), ", ");
  }
  if (route.map_bytes() > 0) {
    HOMING_RETURN_IF_ERROR(session.Print(absl::StrCat(cameras, route.map_bytes(), " bytes")));
  }
  HOMING_RETURN_IF_ERROR(session.Print(absl::StrFormat("\n%8s  %-5s  %15s  %12s  %6s", "landmark",
                                                       "side", "steps", "fingerprints", "spread")));
  for (const v1::Landmark& landmark : landmarks) {
    HOMING_RETURN_IF_ERROR(session.Print(
        absl::StrFormat("%8d  %-5s  %6d - %6d  %12d  %6.2f", landmark.landmark(),
                        Word(landmark.side()), landmark.first_step(), landmark.last_step(),
                        landmark.fingerprint_count(), landmark.spread())));
  }
  return absl::OkStatus();
}

std::string StepsOrMore(bool known, std::int64_t steps) {
  return known ? absl::StrCat(steps, steps == 1 ? " step" : " steps") : "more than 100 steps";
}

absl::Status ShowAliasingTable(const Session& session, const v1::AnalyzeAliasingResponse& report) {
  HOMING_RETURN_IF_ERROR(session.Print(absl::StrFormat(
      "A robot knows its place after %s in half of the places, after %s in nineteen of twenty.",
      StepsOrMore(report.has_median_steps(), report.median_steps()),
      StepsOrMore(report.has_most_steps(), report.most_steps()))));
  if (report.indistinct_share() > 0) {
    HOMING_RETURN_IF_ERROR(
        session.Print(absl::StrFormat("%.1f %% of the places cannot be distinguished from others.",
                                      100 * report.indistinct_share())));
  }
  if (report.twins().empty()) return session.Print("No two places look alike.");
  HOMING_RETURN_IF_ERROR(
      session.Print(absl::StrFormat("\n%8s  %10s  %9s", "step", "looks like", "confusion")));
  for (const v1::Twins& twins : report.twins()) {
    HOMING_RETURN_IF_ERROR(session.Print(absl::StrFormat("%8d  %10d  %9.2f", twins.first_step(),
                                                         twins.second_step(), twins.confusion())));
  }
  return absl::OkStatus();
}

absl::Status ShowAliasing(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  HOMING_ASSIGN_OR_RETURN(
      const v1::AnalyzeAliasingResponse report,
      JourneyClient(&connection, session.stop).AnalyzeAliasing(flags.journey, flags.tolerance));
  return session.json ? session.PrintJson(ToJson(flags.journey, report))
                      : ShowAliasingTable(session, report);
}

absl::Status Show(const Session& session, const JourneysFlags& flags) {
  if (flags.aliasing) return ShowAliasing(session, flags);
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, client.Get(flags.journey));
  absl::StatusOr<v1::DescribeRouteResponse> described = client.DescribeRoute(flags.journey);
  // By an older server.
  if (absl::IsUnimplemented(described.status())) described = v1::DescribeRouteResponse();
  HOMING_ASSIGN_OR_RETURN(const v1::DescribeRouteResponse route, std::move(described));
  std::vector<v1::Landmark> landmarks;
  HOMING_RETURN_IF_ERROR(
      client.ListLandmarks(flags.journey, false, [&](const v1::Landmark& landmark) {
        landmarks.push_back(landmark);
        return absl::OkStatus();
      }));
  if (!session.json) return ShowTable(session, journey, route, landmarks);
  Json line = ToJson(journey);
  line["settings"] = ToJson(journey.settings());
  const MapQuality quality(journey);
  line["quality"] = quality.good ? "GOOD" : "POOR";
  line["quality_reason"] = quality.reason;
  line["cameras"] = Json::object();
  for (const v1::RouteSide& side : route.sides()) {
    line["cameras"][Word(side.side())] = Word(side.direction());
  }
  line["bytes"] = route.map_bytes();
  line["landmarks"] = Json::array();
  for (const v1::Landmark& landmark : landmarks) line["landmarks"].push_back(ToJson(landmark));
  return session.PrintJson(line);
}

absl::Status Finish(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, client.Finish(flags.journey, "", flags.force));
  if (session.json) return session.PrintJson(ToJson(journey));
  HOMING_RETURN_IF_ERROR(session.Print(JourneyHeader()));
  HOMING_RETURN_IF_ERROR(session.Print(JourneyRow(journey)));
  return session.Print(MapQuality(journey).Text());
}

absl::Status SetReaders(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey,
                          client.SetReaders(flags.journey, flags.readers));
  if (session.json) return session.PrintJson(ToJson(journey));
  return session.Print(absl::StrCat(journey.name(), " may be read by its robot",
                                    journey.readers().empty() ? "" : ", ",
                                    absl::StrJoin(journey.readers(), ", ")));
}

absl::Status Delete(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  HOMING_RETURN_IF_ERROR(JourneyClient(&connection, session.stop).Delete(flags.journey));
  if (session.json) return session.PrintJson(Json{{"journey", flags.journey}, {"deleted", true}});
  return session.Print(absl::StrCat("deleted ", flags.journey));
}

// Written to another name and renamed: FILE is complete or does not exist.
absl::Status Export(const Session& session, const JourneysFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  const auto write = [&](std::ostream& file) { return client.Export(flags.journey, file); };
  if (flags.file == "-") return WriteStandardOutput(write);
  HOMING_ASSIGN_OR_RETURN(const std::uintmax_t bytes,
                          WriteOutputFile(flags.file, write, session.stop));
  if (session.json) {
    return session.PrintJson(
        Json{{"journey", flags.journey}, {"file", flags.file}, {"bytes", bytes}});
  }
  return session.Print(WrittenFile(flags.file, bytes));
}

absl::Status Import(const Session& session, const JourneysFlags& flags) {
  errno = 0;
  std::ifstream file(flags.file, std::ios::binary);
  if (!file) return absl::ErrnoToStatus(errno, absl::StrCat("cannot read ", flags.file));
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  JourneyClient client(&connection, session.stop);
  HOMING_ASSIGN_OR_RETURN(const v1::Journey journey, client.Import(flags.journey, file));
  if (session.json) return session.PrintJson(ToJson(journey));
  HOMING_RETURN_IF_ERROR(session.Print(JourneyHeader()));
  return session.Print(JourneyRow(journey));
}

using Action = absl::Status (*)(const Session&, const JourneysFlags&);

CLI::App& AddAction(CLI::App& journeys, Session& session,
                    const std::shared_ptr<JourneysFlags>& flags, const std::string& name,
                    const std::string& help, Action action) {
  CLI::App& command = *journeys.add_subcommand(name, help);
  command.callback([flags, &session, action] {
    session.run = [flags, &session, action] { return action(session, *flags); };
  });
  return command;
}

void AddName(CLI::App& command, JourneysFlags& flags) {
  command.add_option("journey,--journey", flags.journey, "robots/ROBOT/journeys/JOURNEY")
      ->required()
      ->check([](const std::string& text) {
        return std::string(ParseJourneyName(text).status().message());
      });
}

}  // namespace

void AddJourneysCommand(CLI::App& app, Session& session) {
  CLI::App& command =
      *app.add_subcommand("journeys", "List, show, finish, delete, export and import journeys");
  command.require_subcommand(1);
  auto flags = std::make_shared<JourneysFlags>();
  AddAction(command, session, flags, "list", "List all journeys, or those of one robot", List)
      .add_option("parent,--robot", flags->parent, "robots/ROBOT, or robots/- for all")
      ->capture_default_str();
  CLI::App& show =
      AddAction(command, session, flags, "show", "Show one journey and its landmarks", Show);
  AddName(show, *flags);
  show.add_flag("--aliasing", flags->aliasing,
                "Instead: how many steps a robot must see to know its place, and which places look "
                "alike");
  show.add_option("--tolerance", flags->tolerance, "Steps nearer than this count as one place")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str()
      ->needs("--aliasing");
  CLI::App& finish = AddAction(command, session, flags, "finish",
                               "Close a journey whose recording was interrupted", Finish);
  AddName(finish, *flags);
  finish.add_flag("--force", flags->force, "Even while a stream still records it");
  CLI::App& set_readers = AddAction(
      command, session, flags, "set-readers",
      "Set the robots that may read a journey besides its own; without names: none", SetReaders);
  AddName(set_readers, *flags);
  set_readers.add_option("readers,--reader", flags->readers, "robots/ROBOT..., or * for all");
  AddName(AddAction(command, session, flags, "delete", "Delete a journey with its map", Delete),
          *flags);
  CLI::App& to_file =
      AddAction(command, session, flags, "export", "Export a map to one file", Export);
  AddName(to_file, *flags);
  to_file.add_option("file,--out", flags->file, "FILE to write, - for stdout")->required();
  CLI::App& from_file = AddAction(command, session, flags, "import",
                                  "Import a map from one file, under a new name", Import);
  AddName(from_file, *flags);
  from_file.add_option("file,--in", flags->file, "FILE to read")->required();
}

}  // namespace homing::client
