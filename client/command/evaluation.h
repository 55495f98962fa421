// Compares the answers of `homing localize --json` with the true places of both drives.
#ifndef CLIENT_COMMAND_EVALUATION_H_
#define CLIENT_COMMAND_EVALUATION_H_

#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace homing::client {

// One line of truth.csv.
struct TruePlace {
  // Metres along the outbound route from home.
  double metres = 0;
  // By the robot's camera; -1: none.
  std::array<int, 2> landmarks{-1, -1};
};

// truth.csv of `homing simulate`, indexed by sequence. INVALID_ARGUMENT naming the line.
absl::StatusOr<std::vector<TruePlace>> ReadTruth(std::istream& file, const std::string& name);

// One line of `homing localize --json`.
struct LocalizedAnswer {
  std::int64_t sequence = 0;
  // Index in the source; the sequence where a line has none.
  std::int64_t frame = 0;
  std::string outcome;
  std::string motion;
  std::optional<std::int64_t> step;
  // Frame of the outbound drive that made the step.
  std::optional<std::int64_t> step_frame;
  double probability = 0;
  std::optional<double> progress_home;
  std::optional<std::int64_t> landmark;
  std::optional<double> similarity;
};

// INVALID_ARGUMENT naming the line.
absl::StatusOr<std::vector<LocalizedAnswer>> ReadAnswers(std::istream& file,
                                                         const std::string& name);

// Metres in the middle between a frame and the one before.
std::optional<double> PlaceOfFrame(const std::vector<TruePlace>& truth, std::int64_t frame);

struct EvaluatedPlace {
  LocalizedAnswer answer;
  std::optional<double> believed_m;
  std::optional<double> true_m;

  std::optional<double> error_m() const;
};

std::vector<EvaluatedPlace> Evaluate(const std::vector<LocalizedAnswer>& answers,
                                     const std::vector<TruePlace>& outbound,
                                     const std::vector<TruePlace>& home);

struct Verdict {
  // Observations after the first `after_m` of the way home, and those of them within `within_m`.
  std::int64_t counted = 0;
  std::int64_t within = 0;
  // Over the counted observations that name a step; NaN if none does.
  double median_error_m = 0;

  double share() const {
    return counted == 0 ? 0 : static_cast<double>(within) / static_cast<double>(counted);
  }
};

Verdict Judge(const std::vector<EvaluatedPlace>& places, double after_m, double within_m);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_EVALUATION_H_
