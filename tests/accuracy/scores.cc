#include "tests/accuracy/scores.h"

#include <algorithm>
#include <cmath>

namespace homing::accuracy {
namespace {

struct Counted {
  double count = 0;
  double all = 0;
  double Share() const { return all > 0 ? count / all : 0; }
};

void Count(const Run& run, std::size_t first, Outcome outcome, Counted& counted) {
  for (std::size_t i = first; i < run.homing.size(); ++i) {
    counted.count += run.homing[i].outcome == outcome ? 1 : 0;
    counted.all += 1;
  }
}

}  // namespace

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double Median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, half);
  return *half;
}

std::vector<Judgement> Judge(const std::vector<const Run*>& runs, const Answers Run::*method) {
  std::vector<Judgement> judgements;
  for (const Run* run : runs) {
    const Answers& answers = run->*method;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (run->Judged(i)) judgements.push_back({run->Right(answers[i], i), answers[i].score});
    }
  }
  return judgements;
}

double Recall(const std::vector<Judgement>& judgements) {
  const auto right = std::ranges::count_if(judgements, &Judgement::right);
  return judgements.empty() ? 0
                            : static_cast<double>(right) / static_cast<double>(judgements.size());
}

PrecisionRecall PrecisionRecallOf(std::vector<Judgement> judgements) {
  std::ranges::stable_sort(judgements, std::ranges::greater{}, &Judgement::score);
  PrecisionRecall result;
  const auto all = static_cast<double>(judgements.size());
  double taken = 0;
  double right = 0;
  bool full = true;
  for (std::size_t i = 0; i < judgements.size(); ++i) {
    taken += 1;
    right += judgements[i].right ? 1 : 0;
    full = full && judgements[i].right;
    if (full) result.recall_at_full_precision = right / all;
    if (judgements[i].right) result.area += right / taken / all;
    // Answers that are equally sure are taken together.
    if (i + 1 == judgements.size() || judgements[i + 1].score != judgements[i].score) {
      result.curve.push_back({right / all, right / taken});
    }
  }
  return result;
}

Calibration CalibrationOf(std::vector<Judgement> judgements) {
  std::ranges::stable_sort(judgements, {}, &Judgement::score);
  return SortedCalibrationOf(judgements);
}

Calibration SortedCalibrationOf(const std::vector<Judgement>& judgements) {
  constexpr std::size_t kBins = 10;
  Calibration result;
  const auto all = static_cast<double>(judgements.size());
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const std::size_t first = judgements.size() * bin / kBins;
    const std::size_t last = judgements.size() * (bin + 1) / kBins;
    if (first == last) continue;
    Calibration::Bin sum;
    for (std::size_t i = first; i < last; ++i) {
      const double right = judgements[i].right ? 1 : 0;
      sum.probability += judgements[i].score;
      sum.right += right;
      result.brier += std::pow(judgements[i].score - right, 2) / all;
    }
    const auto count = static_cast<double>(last - first);
    result.expected_error += std::abs(sum.probability - sum.right) / all;
    result.bins.push_back({sum.probability / count, sum.right / count});
  }
  return result;
}

double MedianError(const std::vector<const Run*>& runs, const Answers Run::*method) {
  std::vector<double> errors;
  for (const Run* run : runs) {
    const Answers& answers = run->*method;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (run->Judged(i) && !std::isnan(answers[i].place)) {
        errors.push_back(std::abs(answers[i].place - run->query[i]->place));
      }
    }
  }
  return Median(std::move(errors));
}

double TimeToMatch(const Run& run) {
  std::size_t first = 0;
  while (first < run.query.size() && !run.query[first]->MakesStep()) ++first;
  std::size_t i = first;
  while (i < run.homing.size() &&
         (run.homing[i].outcome != Outcome::kMatch || !run.Right(run.homing[i], i))) {
    ++i;
  }
  return static_cast<double>(i - first) + 1;
}

double MedianTimeToMatch(const std::vector<const Run*>& runs) {
  std::vector<double> times;
  for (const Run* run : runs) times.push_back(TimeToMatch(*run));
  return Median(std::move(times));
}

double Share(const std::vector<const Run*>& runs, Outcome outcome) {
  Counted counted;
  for (const Run* run : runs) Count(*run, 0, outcome, counted);
  return counted.Share();
}

double LateShare(const std::vector<const Run*>& runs, Outcome outcome) {
  constexpr std::size_t kLate = 49;
  Counted counted;
  for (const Run* run : runs) {
    const std::size_t size = run->homing.size();
    Count(*run, size > kLate ? kLate : size / 2, outcome, counted);
  }
  return counted.Share();
}

}  // namespace homing::accuracy
