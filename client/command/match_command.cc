#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/flags.h"
#include "client/command/image_pair.h"
#include "client/command/json_line.h"
#include "client/command/real_range.h"
#include "client/homing_client.h"
#include "homing/base/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

struct MatchFlags {
  std::string journey;
  std::string left;
  std::string right;
  std::string travel = "return";
  double threshold = 0.20;
  int matches = 10;
};

absl::Status AddView(const std::string& text, v1::MatchView* view) {
  HOMING_ASSIGN_OR_RETURN(const ImagePair pair, ReadImagePair(text));
  *view->mutable_frames()->mutable_first() = wire::ToProto(pair.first.view());
  *view->mutable_frames()->mutable_second() = wire::ToProto(pair.second.view());
  return absl::OkStatus();
}

absl::Status PrintMatches(const Session& session, const v1::MatchLandmarksResponse& answer) {
  HOMING_RETURN_IF_ERROR(session.Print(
      absl::StrCat("motion ", Word(answer.motion()), ", ", answer.seen_size(), " landmarks seen")));
  if (answer.matches().empty()) return session.Print("no stored landmark resembles them");
  HOMING_RETURN_IF_ERROR(
      session.Print(absl::StrFormat("%5s  %5s  %8s  %8s  %6s  %-5s  %s", "P_T", "P", "delta",
                                    "landmark", "step", "side", "journey")));
  for (const v1::Match& match : answer.matches()) {
    HOMING_RETURN_IF_ERROR(session.Print(absl::StrFormat(
        "%5.2f  %5.2f  %5.1f px  %8d  %6d  %-5s  %s", match.p_t(), match.p(), match.delta(),
        match.landmark(), match.step(), Word(match.side()), match.journey())));
  }
  return absl::OkStatus();
}

absl::Status RunMatch(const Session& session, const MatchFlags& flags) {
  v1::MatchLandmarksRequest request;
  request.set_journey(flags.journey);
  request.set_travel(ToTravel(flags.travel));
  request.set_max_matches(flags.matches);
  request.set_threshold(flags.threshold);
  if (!flags.left.empty()) HOMING_RETURN_IF_ERROR(AddView(flags.left, request.mutable_left()));
  if (!flags.right.empty()) HOMING_RETURN_IF_ERROR(AddView(flags.right, request.mutable_right()));
  HOMING_ASSIGN_OR_RETURN(const Connection connection, session.Connect());
  HomingClient client(&connection);
  HOMING_ASSIGN_OR_RETURN(const auto answer, client.Match(request, session.stop));
  return session.json ? session.PrintJson(ToJson(answer)) : PrintMatches(session, answer);
}

}  // namespace

void AddMatchCommand(CLI::App& app, Session& session) {
  CLI::App& command =
      *app.add_subcommand("match", "Find the stored landmarks that resemble those in two frames");
  auto flags = std::make_shared<MatchFlags>();
  AddJourneyFlag(command, flags->journey, /*wildcards=*/true);
  command.add_option("--left", flags->left, "FIRST,SECOND: consecutive frames of the left camera")
      ->check(CheckImagePair);
  command.add_option("--right", flags->right, "FIRST,SECOND: the same of the right camera")
      ->check(CheckImagePair);
  AddTravelFlag(command, flags->travel);
  command.add_option("--threshold", flags->threshold, "Least P_T of a match")
      ->check(RealRange(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--matches", flags->matches, "Most matches")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.callback([flags, &session] {
    if (flags->left.empty() && flags->right.empty()) {
      throw CLI::RequiredError("--left FIRST,SECOND, --right FIRST,SECOND or both");
    }
    session.run = [flags, &session] { return RunMatch(session, *flags); };
  });
}

}  // namespace homing::client
