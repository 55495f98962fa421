#include "tests/benchmark/plot.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace homing::benchmarks {
namespace {

constexpr double kWidth = 640;
constexpr double kHeight = 400;
constexpr double kLeft = 80;
constexpr double kRight = 20;
constexpr double kTop = 40;
constexpr double kBottom = 60;

// Whole decades around all values.
struct Axis {
  double low = 0;
  double high = 1;
  double from = 0;
  double to = 1;

  double At(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
};

Axis AxisOf(const std::vector<Curve>& curves, bool of_x, double from, double to) {
  Axis axis{1e9, -1e9, from, to};
  for (const Curve& curve : curves) {
    for (const auto& [x, y] : curve.points) {
      axis.low = std::min(axis.low, std::floor(std::log10(of_x ? x : y)));
      axis.high = std::max(axis.high, std::ceil(std::log10(of_x ? x : y)));
    }
  }
  axis.high = std::max(axis.high, axis.low + 1);
  return axis;
}

std::string Text(double x, double y, const std::string& anchor, const std::string& text) {
  return absl::StrFormat("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor,
                         text);
}

std::string Line(double x1, double y1, double x2, double y2) {
  return absl::StrFormat(
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", x1, y1, x2, y2);
}

std::string Grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (double decade = x.low; decade <= x.high; ++decade) {
    const double at = x.At(std::pow(10, decade));
    absl::StrAppend(&svg, Line(at, y.from, at, y.to),
                    Text(at, y.from + 18, "middle", absl::StrFormat("1e%.0f", decade)));
  }
  for (double decade = y.low; decade <= y.high; ++decade) {
    const double at = y.At(std::pow(10, decade));
    absl::StrAppend(&svg, Line(x.from, at, x.to, at),
                    Text(x.from - 6, at + 4, "end", absl::StrFormat("%g", std::pow(10, decade))));
  }
  return svg;
}

std::string Draw(const Curve& curve, const Axis& x, const Axis& y, int number) {
  std::string path;
  std::string dots;
  for (const auto& [px, py] : curve.points) {
    absl::StrAppendFormat(&path, "%.1f,%.1f ", x.At(px), y.At(py));
    absl::StrAppendFormat(&dots, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n",
                          x.At(px), y.At(py), curve.color);
  }
  return absl::StrCat(
      absl::StrFormat("<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n",
                      path, curve.color),
      dots,
      absl::StrFormat("<text x=\"%.1f\" y=\"%.1f\" fill=\"%s\">%s</text>\n", kLeft + 12,
                      kTop + 16 + 17 * number, curve.color, curve.name));
}

}  // namespace

std::string PlotSvg(const std::string& title, const std::string& x_label,
                    const std::string& y_label, const std::vector<Curve>& all) {
  std::vector<Curve> curves;
  std::copy_if(all.begin(), all.end(), std::back_inserter(curves),
               [](const Curve& curve) { return !curve.points.empty(); });
  if (curves.empty()) return "";
  const Axis x = AxisOf(curves, true, kLeft, kWidth - kRight);
  const Axis y = AxisOf(curves, false, kHeight - kBottom, kTop);
  std::string svg = absl::StrFormat(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\""
      " font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  absl::StrAppend(&svg, Grid(x, y), Text(kWidth / 2, 22, "middle", title),
                  Text(kWidth / 2, kHeight - 14, "middle", x_label),
                  Text(12, kTop - 10, "start", y_label));
  int number = 0;
  for (const Curve& curve : curves) absl::StrAppend(&svg, Draw(curve, x, y, number++));
  return svg + "</svg>\n";
}

}  // namespace homing::benchmarks
