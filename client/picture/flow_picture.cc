#include "client/picture/flow_picture.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/picture/axes.h"
#include "homing/base/status_macros.h"
#include "homing/similarity/similarity.h"

namespace homing::client {
namespace {

constexpr double kPanelWidth = 420;
constexpr double kHistogramHeight = 120;
constexpr double kPanelLeft = 52;
constexpr double kPanelTop = 30;
constexpr double kPanelGap = 30;
constexpr double kPanelBottom = 52;
constexpr double kCaptionLine = 15;

Colour LandmarkColour(int landmark, bool compared) {
  if (compared) return kBlue;
  return landmark == 0 ? kBlue : kRed;
}

void DrawVectors(Canvas& canvas, const Axes& axes, const FlowField& field,
                 const LandmarkOptions& options, bool reference, bool compared) {
  const LandmarkSplit split = SplitAtValley(field, options);
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    const FlowVector& vector = field.vectors[i];
    const int landmark = split.assignment[i];
    Colour colour = landmark < 0 ? WithAlpha(kGray, 0.8) : LandmarkColour(landmark, compared);
    if (reference && landmark >= 0) colour = kGreen;
    const Point from = axes.At(double{vector.start_x}, double{vector.start_y});
    const Point to = axes.At(double{vector.end_x}, double{vector.end_y});
    if (landmark < 0) {
      canvas.Disc(from, 1.1, colour);
    } else {
      canvas.Arrow(from, to, colour, 0.9);
    }
  }
}

void DrawMean(Canvas& canvas, const Axes& axes, const SeenLandmark& landmark, Colour colour) {
  const Point at = axes.At(double{landmark.x}, double{landmark.y});
  canvas.Ring(at, 7.5, {1, 1, 1, 1}, 4);
  canvas.Ring(at, 7.5, colour, 2.2);
  canvas.Disc(at, 2, colour);
}

// The reference's landmark with the nearest mean.
const SeenLandmark* Nearest(const std::vector<SeenLandmark>& references,
                            const SeenLandmark& landmark) {
  const auto distance = [&](const SeenLandmark& reference) {
    return std::hypot(reference.x - landmark.x, reference.y - landmark.y);
  };
  const auto nearest =
      std::min_element(references.begin(), references.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return nearest == references.end() ? nullptr : &*nearest;
}

std::string Describe(const SeenLandmark& landmark, const SeenLandmark* reference,
                     const DeviationModel& model) {
  std::string text =
      absl::StrFormat("mean (%.1f, %.1f) px, %d vectors", landmark.x, landmark.y, landmark.count);
  if (reference == nullptr) return text;
  const auto as_mean = [](const SeenLandmark& seen) {
    return MeanAndCount{double{seen.x}, double{seen.y}, static_cast<double>(seen.count)};
  };
  const Similarity similarity = Compare(as_mean(*reference), as_mean(landmark), model);
  return absl::StrCat(
      text, absl::StrFormat(", reference %d; δ = %.1f px, P_T = %.1f %%", reference->count,
                            similarity.delta, 100 * similarity.p_t));
}

void DrawMeans(Canvas& canvas, const Axes& axes, const FlowPanel& panel,
               const FlowPictureOptions& options) {
  const bool compared = panel.reference.has_value();
  std::vector<SeenLandmark> references;
  if (compared) references = FindLandmarks(*panel.reference, options.landmark);
  for (const SeenLandmark& reference : references) DrawMean(canvas, axes, reference, kGreen);
  const auto landmarks = FindLandmarks(panel.field, options.landmark);
  double y = axes.box().y + axes.box().height + kPanelBottom;
  if (landmarks.empty()) canvas.Text({axes.box().x, y}, "no landmark", {11});
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Colour colour = LandmarkColour(static_cast<int>(i), compared);
    const SeenLandmark* reference = compared ? Nearest(references, landmarks[i]) : nullptr;
    if (reference != nullptr) {
      canvas.Line(axes.At(double{reference->x}, double{reference->y}),
                  axes.At(double{landmarks[i].x}, double{landmarks[i].y}), kBlack, 1.2);
    }
    DrawMean(canvas, axes, landmarks[i], colour);
    canvas.Ring({axes.box().x + 5, y - 4}, 4, colour, 2);
    canvas.Text({axes.box().x + 15, y}, Describe(landmarks[i], reference, options.model), {10.5});
    y += kCaptionLine;
  }
}

void DrawVectorPanel(Canvas& canvas, const Box& box, const FlowPanel& panel,
                     const FlowPictureOptions& options) {
  // y grows downwards, as in the image.
  Axes axes(&canvas, box, {0, static_cast<double>(panel.field.width)},
            {static_cast<double>(panel.field.height), 0});
  if (!panel.image.pixels.empty()) canvas.Image(box, panel.image, 0.35);
  axes.Draw({panel.title, "x, pixels", "y, pixels"});
  canvas.Clip(box);
  if (panel.reference) DrawVectors(canvas, axes, *panel.reference, options.landmark, true, true);
  DrawVectors(canvas, axes, panel.field, options.landmark, false, panel.reference.has_value());
  canvas.Unclip();
  DrawMeans(canvas, axes, panel, options);
}

void DrawHistogram(Canvas& canvas, const Box& box, const FlowPanel& panel,
                   const FlowPictureOptions& options) {
  const LandmarkSplit split = SplitAtValley(panel.field, options.landmark);
  const auto bins = static_cast<double>(split.histogram.size());
  const double bin_width = panel.field.width / bins;
  const int highest = split.histogram.empty()
                          ? 1
                          : *std::max_element(split.histogram.begin(), split.histogram.end());
  Axes axes(&canvas, box, {0, static_cast<double>(panel.field.width)},
            {0, 1.15 * std::max(highest, 1)});
  axes.Draw({"midpoints along the direction of travel", "x, pixels", "vectors a bin"});
  for (std::size_t i = 0; i < split.histogram.size(); ++i) {
    const double low = static_cast<double>(i) * bin_width;
    const bool second = split.valley_x && low + bin_width / 2 > *split.valley_x;
    const double top = axes.Y(split.histogram[i]);
    const Box bar{axes.X(low) + 0.5, top, axes.X(low + bin_width) - axes.X(low) - 1,
                  axes.Y(0) - top};
    canvas.Fill(bar, WithAlpha(second ? kRed : kBlue, 0.75));
  }
  if (!split.valley_x) return;
  const double x = axes.X(*split.valley_x);
  canvas.Line({x, box.y}, {x, box.y + box.height}, kBlack, 1.4, /*dashed=*/true);
  canvas.Text({x + 4, box.y + 12}, "valley", {10});
}

double PanelHeight(const FlowPanel& panel) {
  return kPanelWidth * panel.field.height / std::max(panel.field.width, 1);
}

}  // namespace

absl::Status DrawFlow(const std::string& path, const std::vector<FlowPanel>& panels,
                      const FlowPictureOptions& options) {
  double tallest = 0;
  for (const FlowPanel& panel : panels) tallest = std::max(tallest, PanelHeight(panel));
  const double caption = kPanelBottom + kCaptionLine;
  const double histogram = options.histogram ? kPanelTop + kHistogramHeight + kPanelBottom : 0;
  const double column = kPanelLeft + kPanelWidth + kPanelGap;
  HOMING_ASSIGN_OR_RETURN(Canvas canvas,
                          Canvas::Create(path, column * static_cast<double>(panels.size()),
                                         kPanelTop + tallest + caption + histogram + 8));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double x = kPanelLeft + column * static_cast<double>(i);
    DrawVectorPanel(canvas, {x, kPanelTop, kPanelWidth, PanelHeight(panels[i])}, panels[i],
                    options);
    if (!options.histogram) continue;
    DrawHistogram(canvas,
                  {x, kPanelTop + tallest + caption + kPanelTop, kPanelWidth, kHistogramHeight},
                  panels[i], options);
  }
  return canvas.Finish();
}

}  // namespace homing::client
