#include "client/picture/position_picture.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "client/picture/axes.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr double kPageWidth = 760;
constexpr double kPlotLeft = 62;
constexpr double kPlotSpan = 672;
constexpr Box kPlaceBox{kPlotLeft, 34, kPlotSpan, 280};
constexpr Box kErrorBox{kPlotLeft, 372, kPlotSpan, 90};
constexpr Box kProbabilityBox{kPlotLeft, 520, kPlotSpan, 80};
constexpr double kPageHeight = 650;
// Larger errors are drawn at the upper edge.
constexpr double kLargestError = 10;

bool HasTruth(const PositionPicture& picture) {
  return std::any_of(picture.places.begin(), picture.places.end(),
                     [](const BelievedPlace& place) { return place.truth.has_value(); });
}

Range Sequences(const PositionPicture& picture) {
  if (picture.places.empty()) return {0, 1};
  const auto first = static_cast<double>(picture.places.front().sequence);
  const auto last = static_cast<double>(picture.places.back().sequence);
  return {first, std::max(last, first + 1)};
}

void DrawPlaces(Canvas& canvas, const PositionPicture& picture) {
  double highest = 1;
  for (const BelievedPlace& place : picture.places) {
    highest = std::max({highest, place.believed.value_or(0), place.truth.value_or(0)});
  }
  Axes axes(&canvas, kPlaceBox, Sequences(picture), {0, 1.03 * highest});
  axes.Draw({picture.title, "", absl::StrCat("from home, ", picture.unit)});
  std::vector<Point> truth;
  for (const BelievedPlace& place : picture.places) {
    if (place.truth) truth.push_back(axes.At(static_cast<double>(place.sequence), *place.truth));
  }
  canvas.Polyline(truth, WithAlpha(kGreen, 0.55), 5);
  for (const BelievedPlace& place : picture.places) {
    const auto x = static_cast<double>(place.sequence);
    if (place.believed)
      canvas.Disc(axes.At(x, *place.believed), 1.2, place.is_match ? kBlue : kOrange);
  }
  std::vector<LegendEntry> legend = {{"believed, sure (MATCH)", kBlue, false},
                                     {"believed, not sure", kOrange, false}};
  if (!truth.empty()) legend.insert(legend.begin(), {"true place", kGreen});
  axes.Legend(legend);
}

void DrawErrors(Canvas& canvas, const PositionPicture& picture) {
  Axes axes(&canvas, kErrorBox, Sequences(picture), {0, kLargestError});
  axes.Draw({"error", "", picture.unit});
  for (const BelievedPlace& place : picture.places) {
    if (!place.truth || !place.believed) continue;
    const double error = std::min(std::abs(*place.believed - *place.truth), kLargestError);
    canvas.Disc(axes.At(static_cast<double>(place.sequence), error), 1.6,
                place.is_match ? kBlue : kOrange);
  }
}

void DrawProbabilities(Canvas& canvas, const PositionPicture& picture, const Box& box) {
  Axes axes(&canvas, box, Sequences(picture), {0, 1.05});
  axes.Draw({"probability of the interval", "observation on the way home", ""});
  std::vector<Point> points;
  for (const BelievedPlace& place : picture.places) {
    points.push_back(axes.At(static_cast<double>(place.sequence), place.probability));
  }
  canvas.Polyline(points, kPurple, 1.4);
}

}  // namespace

absl::Status DrawPositions(const std::string& path, const PositionPicture& picture) {
  const bool has_truth = HasTruth(picture);
  const double saved = has_truth ? 0 : kProbabilityBox.y - kErrorBox.y;
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPageWidth, kPageHeight - saved));
  DrawPlaces(canvas, picture);
  if (has_truth) DrawErrors(canvas, picture);
  Box probability = kProbabilityBox;
  probability.y -= saved;
  DrawProbabilities(canvas, picture, probability);
  return canvas.Finish();
}

}  // namespace homing::client
