#include "client/command/answer_table.h"

#include "absl/strings/str_cat.h"
#include "client/command/json_line.h"

namespace homing::client {

std::string AnswerTableHead() {
  return "sequence,outcome,motion,journey,step,probability,interval_first,interval_last,"
         "progress_home,direction,landmark,similarity";
}

std::string AnswerTableLine(const v1::LocalizeResponse& answer) {
  const auto number = [](bool known, auto value) { return known ? absl::StrCat(value) : ""; };
  // Names of journeys have neither commas nor quotes.
  return absl::StrCat(
      answer.sequence(), ",", Word(answer.outcome()), ",", Word(answer.motion()), ",",
      absl::StrCat(answer.journey(), ",", number(answer.has_step(), answer.step()), ",",
                   answer.probability(), ",",
                   number(answer.has_interval(), answer.interval().first()), ","),
      number(answer.has_interval(), answer.interval().last()), ",",
      number(answer.has_progress_home(), answer.progress_home()), ",", Word(answer.direction()),
      ",", number(answer.has_landmark(), answer.landmark()), ",",
      number(answer.has_similarity(), answer.similarity()));
}

}  // namespace homing::client
