#include "client/picture/drive_picture.h"

#include <algorithm>
#include <cmath>

#include "client/picture/axes.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr double kDrivePageWidth = 760;
constexpr double kDrivePageHeight = 560;
constexpr Box kAboveBox{62, 52, 672, 164};
constexpr Box kOffsetBox{62, 270, 672, 90};
constexpr Box kHeadingBox{62, 404, 672, 90};
// Larger values are drawn at the edge.
constexpr double kMostOffsetM = 2;
constexpr double kMostHeadingDeg = 30;

Colour OutcomeColour(DrivePicture::Outcome outcome) {
  switch (outcome) {
    case DrivePicture::Outcome::kMatch:
      return kBlue;
    case DrivePicture::Outcome::kAmbiguous:
      return kOrange;
    case DrivePicture::Outcome::kUnknownPlace:
      return kRed;
    case DrivePicture::Outcome::kNone:
      break;
  }
  return kGray;
}

Range Around(double low, double high, double margin) { return {low - margin, high + margin}; }

void DrawFromAbove(Canvas& canvas, const DrivePicture& picture) {
  Range x{1e9, -1e9}, y{1e9, -1e9};
  const auto take = [&](const Point& point) {
    x = {std::min(x.low, point.x), std::max(x.high, point.x)};
    y = {std::min(y.low, point.y), std::max(y.high, point.y)};
  };
  for (const Point& point : picture.outbound) take(point);
  for (const auto& driven : picture.driven) take(driven.place);
  // Widens the range of a straight way, whose line would lie on the edge.
  const double middle = 0.5 * (y.low + y.high);
  y = {std::min(y.low, middle - kMostOffsetM), std::max(y.high, middle + kMostOffsetM)};
  Axes axes(&canvas, kAboveBox, Around(x.low, x.high, 1), Around(y.low, y.high, 1));
  axes.Draw({"", "from above, metres", "metres"});
  canvas.Text({kAboveBox.x, 18}, picture.title, {12, Align::kLeft, kBlack, true});
  std::vector<Point> line;
  for (const Point& point : picture.outbound) line.push_back(axes.At(point.x, point.y));
  canvas.Polyline(line, kPale, 7);
  for (const auto& driven : picture.driven) {
    canvas.Disc(axes.At(driven.place.x, driven.place.y), 1.3, OutcomeColour(driven.outcome));
  }
  if (!line.empty()) canvas.Ring(line.front(), 6, kGreen, 2);
  axes.Legend({{"way out", kPale},
               {"home", kGreen, false},
               {"driven, MATCH", kBlue, false},
               {"AMBIGUOUS", kOrange, false},
               {"UNKNOWN_PLACE", kRed, false}},
              LegendPlace::kAbove);
}

// Plots one value over the way, home at the right.
void DrawOverWay(Canvas& canvas, const DrivePicture& picture, const Box& box, double most,
                 const AxisText& text, double DrivePicture::Driven::*value) {
  double farthest = 1;
  for (const auto& driven : picture.driven) farthest = std::max(farthest, driven.route_m);
  Axes axes(&canvas, box, {farthest, 0}, {-most, most});
  axes.Draw(text);
  canvas.Line(axes.At(farthest, 0), axes.At(0, 0), kGreen, 1);
  canvas.Clip(box);
  for (const auto& driven : picture.driven) {
    canvas.Disc(axes.At(driven.route_m, std::clamp(driven.*value, -most, most)), 1.2,
                OutcomeColour(driven.outcome));
  }
  canvas.Unclip();
}

}  // namespace

absl::Status DrawDrive(const std::string& path, const DrivePicture& picture) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kDrivePageWidth, kDrivePageHeight));
  DrawFromAbove(canvas, picture);
  DrawOverWay(canvas, picture, kOffsetBox, kMostOffsetM, {"left of the way out", "", "metres"},
              &DrivePicture::Driven::left_m);
  DrawOverWay(canvas, picture, kHeadingBox, kMostHeadingDeg,
              {"heading against the way home", "metres from home", "degrees"},
              &DrivePicture::Driven::heading_deg);
  return canvas.Finish();
}

}  // namespace homing::client
