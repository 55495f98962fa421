#include "tests/accuracy/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/picture/axes.h"
#include "homing/base/status_macros.h"
#include "homing/profile/profile_distance.h"

namespace homing::accuracy {
namespace {

using client::Axes;
using client::Canvas;
using client::Colour;
using client::Point;

constexpr client::Box kSquare{62, 40, 400, 400};
constexpr double kPage = 500;
constexpr std::array<Colour, 5> kColours = {client::kBlue, client::kOrange, client::kGreen,
                                            client::kPurple, client::kGray};

std::vector<FlowProfile> ProfilesOf(const std::vector<const Instant*>& instants, std::size_t side) {
  std::vector<FlowProfile> profiles;
  for (const Instant* instant : instants) {
    const auto& field = instant->flow.fields[side];
    profiles.push_back(field ? MakeFlowProfile(*field) : FlowProfile());
  }
  return profiles;
}

std::vector<const Instant*> InstantsOf(const Drive& drive) {
  std::vector<const Instant*> instants;
  for (const Instant& instant : drive) instants.push_back(&instant);
  return instants;
}

// A column an instant of the way home, a row a step, home at the bottom; the more alike the darker.
client::GrayImage MatrixOf(const Run& run) {
  const Drive& map = *run.maps[0];
  client::GrayImage image{static_cast<int>(run.query.size()), static_cast<int>(map.size()), {}};
  std::vector<double> sums(run.query.size() * map.size());
  const CellMask all = CoveredCells(1);
  std::vector<std::uint16_t> distances(map.size());
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const auto side =
        static_cast<std::size_t>(RouteSide(Side{static_cast<int>(camera)}, run.travel));
    const auto stored = ProfilesOf(InstantsOf(map), side);
    const auto seen = ProfilesOf(run.query, camera);
    for (std::size_t q = 0; q < seen.size(); ++q) {
      ProfileDistances(seen[q], stored, all, distances);
      for (std::size_t m = 0; m < map.size(); ++m) {
        sums[(map.size() - 1 - m) * seen.size() + q] += distances[m];
      }
    }
  }
  const double most = *std::ranges::max_element(sums);
  for (const double sum : sums) {
    image.pixels.push_back(static_cast<char>(std::lround(255 * std::pow(sum / most, 0.7))));
  }
  return image;
}

void DrawPath(Canvas& canvas, const Axes& axes, const Run& run) {
  for (std::size_t q = 0; q < run.query.size(); ++q) {
    const auto x = static_cast<double>(q);
    const double truth = run.query[q]->place;
    if (!std::isnan(truth)) canvas.Disc(axes.At(x, truth), 2.2, WithAlpha(client::kGreen, 0.5));
  }
  for (std::size_t q = 0; q < run.homing.size(); ++q) {
    const Answer& answer = run.homing[q];
    if (std::isnan(answer.place)) continue;
    const bool sure = answer.outcome == Outcome::kMatch;
    canvas.Disc(axes.At(static_cast<double>(q), answer.place), 1.1,
                sure ? client::kBlue : client::kRed);
  }
}

}  // namespace

absl::Status DrawSimilarityMatrix(const std::string& path, const Run& run) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPage, kPage));
  const Drive& map = *run.maps[0];
  Axes axes(&canvas, kSquare, {0, static_cast<double>(run.query.size())},
            {map.front().place, map.back().place});
  canvas.Image(kSquare, MatrixOf(run), 0.8);
  axes.Draw({run.set + ": profile distances (dark: alike)", "observation", "place on the route"});
  DrawPath(canvas, axes, run);
  axes.Legend({{"true place", client::kGreen, false},
               {"believed, MATCH", client::kBlue, false},
               {"believed, not sure", client::kRed, false}},
              client::LegendPlace::kLowerRight);
  return canvas.Finish();
}

absl::Status DrawPrecisionRecall(const std::string& path, const std::string& title,
                                 const std::vector<NamedCurve>& curves) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPage, kPage));
  Axes axes(&canvas, kSquare, {0, 1}, {0, 1.02});
  axes.Draw({title, "recall", "precision"});
  std::vector<client::LegendEntry> legend;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Colour colour = kColours[i % kColours.size()];
    std::vector<Point> points;
    for (const auto& point : curves[i].curve.curve) {
      points.push_back(axes.At(point.recall, point.precision));
    }
    canvas.Polyline(points, colour, 2);
    legend.push_back({curves[i].name, colour, true});
  }
  axes.Legend(legend, client::LegendPlace::kLowerRight);
  return canvas.Finish();
}

absl::Status DrawReliability(const std::string& path,
                             const std::vector<NamedCalibration>& calibrations) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPage, kPage));
  Axes axes(&canvas, kSquare, {0, 1}, {0, 1.02});
  axes.Draw(
      {"Of the answers of one probability, how many are right", "probability", "share right"});
  canvas.Line(axes.At(0, 0), axes.At(1, 1), client::kGray, 1, true);
  std::vector<client::LegendEntry> legend;
  for (std::size_t i = 0; i < calibrations.size(); ++i) {
    const Colour colour = kColours[i % kColours.size()];
    std::vector<Point> points;
    for (const auto& bin : calibrations[i].calibration.bins) {
      points.push_back(axes.At(bin.probability, bin.right));
      canvas.Disc(points.back(), 3, colour);
    }
    canvas.Polyline(points, colour, 1.5);
    legend.push_back({calibrations[i].name, colour, true});
  }
  axes.Legend(legend, client::LegendPlace::kLowerRight);
  return canvas.Finish();
}

}  // namespace homing::accuracy
