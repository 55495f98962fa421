#include "client/picture/journey_strip.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/picture/axes.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::array<const char*, 2> kSideTitles = {"left side of the route",
                                                    "right side of the route"};
constexpr double kStripWidth = 940;
constexpr double kLaneTop = 54;
constexpr double kLaneHeight = 150;
constexpr double kLaneGap = 66;
constexpr double kCountHeight = 90;
constexpr double kLaneLeft = 60;
constexpr double kImageWidth = 400;
constexpr double kImageHeight = 300;
// Half the width of a mean's caption.
constexpr double kCaptionHalf = 76;
constexpr double kLaneWidth = 860;
// Width of a digit; overlapping numbers are omitted.
constexpr double kDigitWidth = 6.2;

struct Track {
  std::int64_t first = 0;
  std::int64_t last = 0;
  double first_x = 0;
};

double Width(const JourneyStrip& strip, std::size_t side) {
  double width = strip.widths[side];
  for (const auto& seen : strip.fingerprints) {
    width = std::max(width, std::ceil(double{seen.fingerprint.x}));
  }
  return std::max(width, 1.0);
}

std::map<std::int32_t, Track> Tracks(const JourneyStrip& strip, Side side) {
  std::map<std::int32_t, Track> tracks;
  for (const StripFingerprint& seen : strip.fingerprints) {
    if (seen.side != side) continue;
    const auto [track, is_new] = tracks.try_emplace(
        seen.fingerprint.landmark, Track{seen.step, seen.step, double{seen.fingerprint.x}});
    if (!is_new) track->second.last = std::max(track->second.last, seen.step);
  }
  return tracks;
}

void DrawLane(Canvas& canvas, const Box& box, const JourneyStrip& strip, Side side) {
  const auto index = static_cast<std::size_t>(side);
  Axes axes(&canvas, box, {0, static_cast<double>(std::max<std::int64_t>(strip.step_count, 1))},
            {0, Width(strip, index)});
  axes.Draw({kSideTitles[index], "", "mean x, pixels"});
  for (const StripFingerprint& seen : strip.fingerprints) {
    if (seen.side != side) continue;
    canvas.Disc(axes.At(static_cast<double>(seen.step) + 0.5, double{seen.fingerprint.x}), 1.7,
                ColourOf(seen.fingerprint.landmark));
  }
  double free_from = box.x;
  for (const auto& [landmark, track] : Tracks(strip, side)) {
    const double x = axes.X(static_cast<double>(track.first) + 0.5);
    if (x < free_from) continue;
    const std::string number = absl::StrCat(landmark);
    free_from = x + kDigitWidth * static_cast<double>(number.size()) + 5;
    canvas.Text({x, box.y + 10}, number, {8.5, Align::kLeft, ColourOf(landmark), true});
  }
}

void DrawCounts(Canvas& canvas, const Box& box, const JourneyStrip& strip) {
  int highest = 1;
  for (const auto& seen : strip.fingerprints) highest = std::max(highest, seen.fingerprint.count);
  Axes axes(&canvas, box, {0, static_cast<double>(std::max<std::int64_t>(strip.step_count, 1))},
            {0, 1.1 * highest});
  axes.Draw({"number of vectors of each fingerprint", "step, from home", "vectors"});
  for (const StripFingerprint& seen : strip.fingerprints) {
    canvas.Disc(axes.At(static_cast<double>(seen.step) + 0.5, seen.fingerprint.count), 1.4,
                WithAlpha(seen.side == Side::kLeft ? kBlue : kRed, 0.75));
  }
  axes.Legend({{"left", kBlue, false}, {"right", kRed, false}}, LegendPlace::kAbove);
}

void DrawMeanOfStep(Canvas& canvas, const Axes& axes, const Fingerprint& fingerprint) {
  const Colour colour = ColourOf(fingerprint.landmark);
  const Point at = axes.At(double{fingerprint.x}, double{fingerprint.y});
  // The area is proportional to the number of vectors.
  canvas.Disc(at, 2 * std::sqrt(fingerprint.count), WithAlpha(colour, 0.3));
  canvas.Ring(at, 6, colour, 2.2);
  const TextStyle style{10.5, Align::kCenter};
  const Box& box = axes.box();
  const double x = std::clamp(at.x, box.x + kCaptionHalf, box.x + box.width - kCaptionHalf);
  const double below = at.y + 2 * std::sqrt(fingerprint.count) + 14;
  canvas.Text({x, below}, absl::StrCat("landmark ", fingerprint.landmark), style);
  canvas.Text(
      {at.x, below + 13},
      absl::StrFormat("(%.1f, %.1f), %d vectors", fingerprint.x, fingerprint.y, fingerprint.count),
      style);
}

void DrawView(Canvas& canvas, const JourneyStrip& strip, std::int64_t step, Side side) {
  const auto index = static_cast<std::size_t>(side);
  const double x = kLaneLeft + static_cast<double>(index) * (kImageWidth + 70);
  const double width = Width(strip, index);
  const double height = strip.heights[index] > 0 ? strip.heights[index] : 0.75 * width;
  Axes axes(&canvas, {x, kLaneTop, kImageWidth, kImageHeight}, {0, width}, {height, 0});
  axes.Draw({kSideTitles[index], "x, pixels", "y, pixels"});
  for (const StripFingerprint& seen : strip.fingerprints) {
    if (seen.step == step && seen.side == side) DrawMeanOfStep(canvas, axes, seen.fingerprint);
  }
}

}  // namespace

absl::Status DrawJourneyStrip(const std::string& path, const JourneyStrip& strip) {
  const double height = kLaneTop + 2 * (kLaneHeight + kLaneGap) + kCountHeight + 44;
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kStripWidth, height));
  canvas.Text({kLaneLeft, 22}, strip.title, {14, Align::kLeft, kBlack, true});
  double y = kLaneTop;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    DrawLane(canvas, {kLaneLeft, y, kLaneWidth, kLaneHeight}, strip, side);
    y += kLaneHeight + kLaneGap;
  }
  DrawCounts(canvas, {kLaneLeft, y, kLaneWidth, kCountHeight}, strip);
  return canvas.Finish();
}

absl::Status DrawJourneyStep(const std::string& path, const JourneyStrip& strip,
                             std::int64_t step) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, 2 * kImageWidth + 150, 410));
  canvas.Text({kLaneLeft, 22}, absl::StrCat(strip.title, ", step ", step),
              {14, Align::kLeft, kBlack, true});
  for (const Side side : {Side::kLeft, Side::kRight}) DrawView(canvas, strip, step, side);
  return canvas.Finish();
}

}  // namespace homing::client
