#include "client/command/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::size_t kMaxInstants = 10'000'000;

absl::Status BadLine(const std::string& name, std::int64_t line, const std::string& why) {
  return absl::InvalidArgumentError(absl::StrCat(name, ", line ", line, ": ", why));
}

template <typename Value>
std::optional<Value> Find(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<Value>();
}

std::string FindText(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

bool AddTruth(const std::string& line, std::vector<TruePlace>& truth) {
  const std::vector<std::string> fields = absl::StrSplit(line, ',');
  std::size_t sequence = 0;
  double metres = 0;
  int landmark = -1;
  const bool good = fields.size() == 4 && absl::SimpleAtoi(fields[0], &sequence) &&
                    (fields[1] == "left" || fields[1] == "right") &&
                    absl::SimpleAtod(fields[2], &metres) && absl::SimpleAtoi(fields[3], &landmark);
  if (!good || sequence >= kMaxInstants) return false;
  if (truth.size() <= sequence) truth.resize(sequence + 1);
  truth[sequence].metres = metres;
  truth[sequence].landmarks[fields[1] == "left" ? 0 : 1] = landmark;
  return true;
}

}  // namespace

absl::StatusOr<std::vector<TruePlace>> ReadTruth(std::istream& file, const std::string& name) {
  std::vector<TruePlace> truth;
  std::string line;
  std::getline(file, line);
  if (line != "sequence,camera,metres,landmark") {
    return BadLine(name, 1, "expected sequence,camera,metres,landmark");
  }
  for (std::int64_t number = 2; std::getline(file, line); ++number) {
    if (!AddTruth(line, truth)) return BadLine(name, number, absl::StrCat("cannot read ", line));
  }
  return truth;
}

absl::StatusOr<std::vector<LocalizedAnswer>> ReadAnswers(std::istream& file,
                                                         const std::string& name) {
  std::vector<LocalizedAnswer> answers;
  std::string line;
  for (std::int64_t number = 1; std::getline(file, line); ++number) {
    const auto object = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!object.is_object()) return BadLine(name, number, "not a JSON object");
    const auto sequence = Find<std::int64_t>(object, "sequence");
    if (!sequence) return BadLine(name, number, "no sequence");
    LocalizedAnswer answer;
    answer.sequence = *sequence;
    answer.frame = Find<std::int64_t>(object, "frame").value_or(*sequence);
    answer.outcome = FindText(object, "outcome");
    answer.motion = FindText(object, "motion");
    answer.step = Find<std::int64_t>(object, "step");
    answer.step_frame = Find<std::int64_t>(object, "step_frame");
    answer.probability = Find<double>(object, "probability").value_or(0);
    answer.progress_home = Find<double>(object, "progress_home");
    answer.landmark = Find<std::int64_t>(object, "landmark");
    answer.similarity = Find<double>(object, "similarity");
    answers.push_back(std::move(answer));
  }
  return answers;
}

std::optional<double> PlaceOfFrame(const std::vector<TruePlace>& truth, std::int64_t frame) {
  if (frame < 1 || frame >= static_cast<std::int64_t>(truth.size())) return std::nullopt;
  const auto index = static_cast<std::size_t>(frame);
  return 0.5 * (truth[index - 1].metres + truth[index].metres);
}

std::optional<double> EvaluatedPlace::error_m() const {
  if (!believed_m || !true_m) return std::nullopt;
  return std::abs(*believed_m - *true_m);
}

std::vector<EvaluatedPlace> Evaluate(const std::vector<LocalizedAnswer>& answers,
                                     const std::vector<TruePlace>& outbound,
                                     const std::vector<TruePlace>& home) {
  std::vector<EvaluatedPlace> places;
  for (const LocalizedAnswer& answer : answers) {
    EvaluatedPlace place;
    place.answer = answer;
    if (answer.step) {
      // Lines of earlier versions: each frame but the first made a step.
      place.believed_m = PlaceOfFrame(outbound, answer.step_frame.value_or(*answer.step + 1));
    }
    place.true_m = PlaceOfFrame(home, answer.frame);
    places.push_back(std::move(place));
  }
  return places;
}

Verdict Judge(const std::vector<EvaluatedPlace>& places, double after_m, double within_m) {
  Verdict verdict;
  std::optional<double> begin;
  std::vector<double> errors;
  for (const EvaluatedPlace& place : places) {
    if (!place.true_m) continue;
    if (!begin) begin = place.true_m;
    if (std::abs(*place.true_m - *begin) < after_m) continue;
    ++verdict.counted;
    const auto error = place.error_m();
    if (!error) continue;
    errors.push_back(*error);
    if (*error <= within_m) ++verdict.within;
  }
  verdict.median_error_m = std::numeric_limits<double>::quiet_NaN();
  if (errors.empty()) return verdict;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  verdict.median_error_m = *middle;
  return verdict;
}

}  // namespace homing::client
