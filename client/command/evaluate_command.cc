#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/evaluation.h"
#include "client/command/json_line.h"
#include "client/command/real_range.h"
#include "client/picture/position_picture.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

struct EvaluateFlags {
  std::string answers;
  std::string truth_out;
  std::string truth_home;
  std::string out;
  double after_m = 10;
  double within_m = 2;
  double require = 0;
  int rows = 20;
};

absl::StatusOr<std::vector<TruePlace>> ReadTruthFile(const std::string& path) {
  if (path.empty()) return std::vector<TruePlace>();
  std::ifstream file(path);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read ", path));
  return ReadTruth(file, path);
}

absl::StatusOr<std::vector<LocalizedAnswer>> ReadAnswersFile(const std::string& path) {
  if (path == "-") return ReadAnswers(std::cin, "standard input");
  std::ifstream file(path);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read ", path));
  return ReadAnswers(file, path);
}

std::string Metres(const std::optional<double>& metres) {
  return metres ? absl::StrFormat("%.1f m", *metres) : "-";
}

// Without the truth: the believed step, and the progress home.
std::string PlaceRow(const EvaluatedPlace& place, bool judged) {
  const LocalizedAnswer& answer = place.answer;
  const std::string where =
      judged ? absl::StrFormat("%9s  %9s  %7s", Metres(place.true_m), Metres(place.believed_m),
                               Metres(place.error_m()))
             : absl::StrFormat("%9s  %9s", answer.step ? absl::StrCat(*answer.step) : "-",
                               answer.progress_home
                                   ? absl::StrFormat("%.0f %%", 100 * *answer.progress_home)
                                   : "-");
  return absl::StrFormat("%8d  %s  %-13s  %8s  %5s  %5.2f", answer.sequence, where, answer.outcome,
                         answer.landmark ? absl::StrCat(*answer.landmark) : "-",
                         answer.similarity ? absl::StrFormat("%.2f", *answer.similarity) : "-",
                         answer.probability);
}

absl::Status PrintPlaces(const Session& session, const std::vector<EvaluatedPlace>& places,
                         const EvaluateFlags& flags) {
  const bool judged = !flags.truth_home.empty();
  const std::string where = judged ? absl::StrFormat("%9s  %9s  %7s", "true", "believed", "error")
                                   : absl::StrFormat("%9s  %9s", "step", "way home");
  HOMING_RETURN_IF_ERROR(session.Print(absl::StrFormat(
      "%8s  %s  %-13s  %8s  %5s  %5s", "sequence", where, "outcome", "landmark", "P_T", "prob")));
  const int rows = flags.rows;
  const std::size_t wanted = rows == 0 ? places.size() : static_cast<std::size_t>(rows);
  const std::size_t stride =
      std::max<std::size_t>(1, (places.size() + wanted - 1) / std::max<std::size_t>(wanted, 1));
  for (std::size_t i = 0; i < places.size(); i += stride) {
    HOMING_RETURN_IF_ERROR(session.Print(PlaceRow(places[i], judged)));
  }
  return absl::OkStatus();
}

std::int64_t CountMatches(const std::vector<EvaluatedPlace>& places) {
  return std::count_if(places.begin(), places.end(),
                       [](const auto& place) { return place.answer.outcome == "MATCH"; });
}

std::string VerdictText(const EvaluateFlags& flags, const std::vector<EvaluatedPlace>& places,
                        const Verdict& verdict) {
  const std::string matches =
      absl::StrFormat("%d of %d answers are MATCH", CountMatches(places), places.size());
  if (flags.truth_home.empty()) return absl::StrCat("verdict: ", matches, "; no truth to compare");
  std::string text = absl::StrFormat(
      "verdict: %d of %d observations (%.1f %%) within %g m of the truth after the first %g m of "
      "the way home, median error %.2f m; %s",
      verdict.within, verdict.counted, 100 * verdict.share(), flags.within_m, flags.after_m,
      verdict.median_error_m, matches);
  if (flags.require > 0) {
    absl::StrAppend(&text, absl::StrFormat("; %.1f %% required: %s", 100 * flags.require,
                                           verdict.share() >= flags.require ? "passed" : "FAILED"));
  }
  return text;
}

absl::Status PrintVerdict(const Session& session, const EvaluateFlags& flags,
                          const std::vector<EvaluatedPlace>& places, const Verdict& verdict) {
  if (!session.json) {
    HOMING_RETURN_IF_ERROR(PrintPlaces(session, places, flags));
    return session.Print(VerdictText(flags, places, verdict));
  }
  const bool judged = !flags.truth_home.empty();
  const bool has_median = judged && std::isfinite(verdict.median_error_m);
  return session.PrintJson(
      Json{{"observations", places.size()},
           {"matches", CountMatches(places)},
           {"counted", verdict.counted},
           {"within", verdict.within},
           {"share", judged ? Json(verdict.share()) : Json()},
           {"median_error_m", has_median ? Json(verdict.median_error_m) : Json()}});
}

absl::Status DrawEvaluation(const EvaluateFlags& flags, const std::vector<EvaluatedPlace>& places) {
  std::error_code error;
  std::filesystem::create_directories(flags.out, error);
  const bool judged = !flags.truth_home.empty();
  PositionPicture picture;
  picture.title = "The way home: believed and true place";
  if (!judged) picture.title = "The way home: believed step";
  picture.unit = judged ? "metres" : "steps";
  for (const EvaluatedPlace& place : places) {
    BelievedPlace drawn{place.answer.sequence, place.believed_m, place.true_m,
                        place.answer.probability, place.answer.outcome == "MATCH"};
    if (!judged && place.answer.step) drawn.believed = static_cast<double>(*place.answer.step);
    picture.places.push_back(drawn);
  }
  for (const char* ending : {".svg", ".png"}) {
    HOMING_RETURN_IF_ERROR(DrawPositions(absl::StrCat(flags.out, "/way_home", ending), picture));
  }
  return absl::OkStatus();
}

absl::Status RunEvaluate(const Session& session, const EvaluateFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const auto answers, ReadAnswersFile(flags.answers));
  if (answers.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(flags.answers, " holds no answers"));
  }
  HOMING_ASSIGN_OR_RETURN(const auto outbound, ReadTruthFile(flags.truth_out));
  HOMING_ASSIGN_OR_RETURN(const auto home, ReadTruthFile(flags.truth_home));
  const auto places = Evaluate(answers, outbound, home);
  const Verdict verdict = Judge(places, flags.after_m, flags.within_m);
  HOMING_RETURN_IF_ERROR(PrintVerdict(session, flags, places, verdict));
  if (!flags.out.empty()) HOMING_RETURN_IF_ERROR(DrawEvaluation(flags, places));
  if (verdict.share() >= flags.require) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrFormat(
      "the fraction %.3f is below the required %.3f", verdict.share(), flags.require));
}

}  // namespace

void AddEvaluateCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand("evaluate",
                                          "Judge the answers of `localize --json`, against "
                                          "truth.csv of both drives where there is one");
  auto flags = std::make_shared<EvaluateFlags>();
  command.add_option("--answers", flags->answers, "FILE of JSON lines, - for stdin")->required();
  CLI::Option* outbound =
      command.add_option("--truth-out", flags->truth_out, "truth.csv of the outbound drive");
  CLI::Option* home =
      command.add_option("--truth-home", flags->truth_home, "truth.csv of the drive home");
  outbound->needs(home);
  home->needs(outbound);
  command.add_option("--after", flags->after_m, "Metres of the way home that do not count")
      ->capture_default_str();
  command.add_option("--within", flags->within_m, "Largest error of a right answer, metres")
      ->capture_default_str();
  command
      .add_option("--require", flags->require,
                  "Least fraction of right answers; below it the exit code is 1")
      ->check(RealRange(0.0, 1.0))
      ->needs(home);
  command.add_option("--rows", flags->rows, "Rows of the table, 0 for all")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command.add_option("--out", flags->out, "DIR for the picture way_home.svg and .png");
  command.callback([flags, &session] {
    session.run = [flags, &session] { return RunEvaluate(session, *flags); };
  });
}

}  // namespace homing::client
