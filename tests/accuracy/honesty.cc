#include "tests/accuracy/honesty.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace homing::accuracy {
namespace {

// Of probabilities that went over the wire.
constexpr double kRounding = 1e-6;

bool Agrees(const Answer& answer) {
  const bool is_match = answer.outcome == Outcome::kMatch;
  const bool is_unknown = answer.outcome == Outcome::kUnknownPlace;
  const bool is_sure =
      is_match ? answer.score >= 0.90 - kRounding : answer.score < 0.90 + kRounding;
  const bool is_lost =
      is_unknown ? answer.on_route <= 0.50 + kRounding : answer.on_route > 0.50 - kRounding;
  return is_sure && is_lost && answer.score <= answer.on_route + kRounding;
}

}  // namespace

MatchCount CountMatches(const std::vector<const Run*>& runs) {
  MatchCount count;
  for (const Run* run : runs) {
    for (std::size_t i = 0; i < run->homing.size(); ++i) {
      if (!run->Judged(i)) continue;
      ++count.answers;
      if (run->homing[i].outcome != Outcome::kMatch) continue;
      ++count.matches;
      count.right += run->RightEnough(run->homing[i], i) ? 1 : 0;
    }
  }
  return count;
}

std::vector<Judgement> JudgeEnough(const std::vector<const Run*>& runs) {
  std::vector<Judgement> judgements;
  for (const Run* run : runs) {
    for (std::size_t i = 0; i < run->homing.size(); ++i) {
      if (!run->Judged(i)) continue;
      judgements.push_back({run->RightEnough(run->homing[i], i), run->homing[i].score});
    }
  }
  return judgements;
}

double PerfectCalibrationError(const std::vector<Judgement>& judgements) {
  constexpr int kDraws = 1000;
  std::vector<Judgement> drawn = judgements;
  std::ranges::stable_sort(drawn, {}, &Judgement::score);
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  double sum = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (Judgement& judgement : drawn) judgement.right = uniform(engine) < judgement.score;
    sum += SortedCalibrationOf(drawn).expected_error;
  }
  return sum / kDraws;
}

int CountDisagreements(const std::vector<const Run*>& runs) {
  int count = 0;
  for (const Run* run : runs) {
    for (std::size_t i = 0; i < run->homing.size(); ++i) {
      count += Agrees(run->homing[i]) ? 0 : 1;
    }
  }
  return count;
}

}  // namespace homing::accuracy
