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

// A column a step of the way home, a row a step, home at the bottom; the more alike the darker.
client::GrayImage MatrixOf(const Run& run) {
  const auto map = StepsOf(*run.maps[0]);
  const auto query = run.QuerySteps();
  client::GrayImage image{static_cast<int>(query.size()), static_cast<int>(map.size()), {}};
  std::vector<double> sums(query.size() * map.size());
  const CellMask all = CoveredCells(1);
  std::vector<std::uint16_t> distances(map.size());
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const auto side =
        static_cast<std::size_t>(RouteSide(Side{static_cast<int>(camera)}, run.travel));
    const auto stored = ProfilesOf(map, side);
    const auto seen = ProfilesOf(query, camera);
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
  double step = -1;
  for (std::size_t i = 0; i < run.query.size(); ++i) {
    if (!run.query[i]->MakesStep()) continue;
    step += 1;
    const double truth = run.query[i]->place;
    if (!std::isnan(truth)) canvas.Disc(axes.At(step, truth), 2.2, WithAlpha(client::kGreen, 0.5));
  }
  step = -1;
  for (std::size_t i = 0; i < run.homing.size(); ++i) {
    if (!run.query[i]->MakesStep()) continue;
    step += 1;
    const Answer& answer = run.homing[i];
    if (std::isnan(answer.place)) continue;
    const bool sure = answer.outcome == Outcome::kMatch;
    canvas.Disc(axes.At(step, answer.place), 1.1, sure ? client::kBlue : client::kRed);
  }
}

}  // namespace

absl::Status DrawSimilarityMatrix(const std::string& path, const Run& run) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPage, kPage));
  const Drive& map = *run.maps[0];
  Axes axes(&canvas, kSquare, {0, static_cast<double>(run.QuerySteps().size())},
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
