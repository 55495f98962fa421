#include "tests/drive/projected_eyes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "client/simulator/seeded_random.h"
#include "client/simulator/texture_pool.h"
#include "client/simulator/view.h"
#include "homing/flow/motion.h"

namespace homing::client {
namespace {

constexpr int kWidth = Simulator::kWidth;
constexpr int kHeight = Simulator::kHeight;
// One corner a cell, as the tracker has it.
constexpr int kCellPx = 8;
constexpr int kColumns = kWidth / kCellPx;
constexpr int kRows = kHeight / kCellPx;
// Corners farther along the route are not seen, m.
constexpr double kReachM = 25;
// Corners a square metre of ground.
constexpr double kGroundCorners = 0.7;
constexpr double kGroundHalfWidthM = 7;

// Corners of one tile, the same wherever the texture is.
const std::vector<Vector2>& CornersOf(int texture) {
  static const auto all = [] {
    std::array<std::vector<Vector2>, kTextureCount> tiles;
    for (int kind = 0; kind < kTextureCount; ++kind) {
      SeededRandom random(Mix(0xC0F4, static_cast<std::uint64_t>(kind)));
      const int corners = 14 + random.Below(40);
      for (int i = 0; i < corners; ++i) {
        tiles[static_cast<std::size_t>(kind)].emplace_back(random.Uniform(0, 1),
                                                           random.Uniform(0, 1));
      }
    }
    return tiles;
  }();
  return all[static_cast<std::size_t>(texture)];
}

// Places of the texture's corners on a sheet of this size, m from its own corner.
std::vector<Vector2> Papered(const Material& material, double width_m, double height_m) {
  std::vector<Vector2> places;
  const double tile_m = material.tile_m;
  for (double u = -material.offset[0] * tile_m; u < width_m; u += tile_m) {
    for (double v = -material.offset[1] * tile_m; v < height_m; v += tile_m) {
      for (const Vector2& corner : CornersOf(material.texture)) {
        const Vector2 place(u + corner[0] * tile_m, v + corner[1] * tile_m);
        if (place[0] >= 0 && place[0] <= width_m && place[1] >= 0 && place[1] <= height_m) {
          places.push_back(place);
        }
      }
    }
  }
  return places;
}

std::vector<Vector3> CornersOn(const Parallelogram& shape, const Material& material) {
  const double width_m = cv::norm(shape.edge_u);
  const double height_m = cv::norm(shape.edge_v);
  std::vector<Vector3> corners;
  for (const Vector2& place : Papered(material, width_m, height_m)) {
    corners.push_back(shape.corner + place[0] / width_m * shape.edge_u +
                      place[1] / height_m * shape.edge_v);
  }
  return corners;
}

std::vector<Vector3> CornersOn(const Cylinder& shape, const Material& material) {
  std::vector<Vector3> corners;
  for (const Vector2& place : Papered(material, kTurn * shape.radius, shape.top - shape.bottom)) {
    const double angle = place[0] / shape.radius;
    corners.emplace_back(shape.center[0] + shape.radius * std::cos(angle),
                         shape.center[1] + shape.radius * std::sin(angle), shape.bottom + place[1]);
  }
  return corners;
}

std::vector<Vector3> CornersOn(const Ellipsoid& shape, const Material& material) {
  const double girth_m = kTurn * 0.5 * (shape.half_axes[0] + shape.half_axes[1]);
  const double c = std::cos(shape.heading), s = std::sin(shape.heading);
  std::vector<Vector3> corners;
  for (const Vector2& place : Papered(material, girth_m, kTurn / 2 * shape.half_axes[2])) {
    const double angle = kTurn * place[0] / girth_m;
    const double height = place[1] / shape.half_axes[2] - kTurn / 4;
    const double x = shape.half_axes[0] * std::cos(height) * std::cos(angle);
    const double y = shape.half_axes[1] * std::cos(height) * std::sin(angle);
    const Vector3 corner =
        shape.center + Vector3(c * x - s * y, s * x + c * y, shape.half_axes[2] * std::sin(height));
    if (corner[2] >= 0) corners.push_back(corner);
  }
  return corners;
}

std::vector<Vector3> CornersOn(const Ground&, const Material&) { return {}; }
std::vector<Vector3> CornersOn(const Skyline&, const Material&) { return {}; }

bool Inside(double x, double y) { return x >= 0 && x < kWidth - 1 && y >= 0 && y < kHeight - 1; }

}  // namespace

ProjectedEyes::ProjectedEyes(const PosedCameras* cameras, const ProjectedEyesOptions& options)
    : cameras_(cameras), options_(options) {
  for (const Surface& surface : cameras->scene().surfaces()) AddCorners(surface);
  AddGround();
  std::ranges::stable_sort(corners_, {}, &Corner::route_m);
}

void ProjectedEyes::AddCorners(const Surface& surface) {
  const auto corners = std::visit(
      [&](const auto& shape) { return CornersOn(shape, surface.material); }, surface.shape);
  for (const Vector3& corner : corners) corners_.push_back({corner, surface.route_m});
}

void ProjectedEyes::AddGround() {
  const Route& route = cameras_->route();
  SeededRandom random(0x6209);
  for (double route_m = -30; route_m < route.length_m() + 30; route_m += 1) {
    const int corners = static_cast<int>(kGroundCorners * 2 * kGroundHalfWidthM);
    for (int i = 0; i < corners; ++i) {
      const double at_m = route_m + random.Uniform(0, 1);
      const double left_m = random.Uniform(-kGroundHalfWidthM, kGroundHalfWidthM);
      corners_.push_back({Raise(route.At(at_m).At(0, left_m), 0), at_m});
    }
  }
}

FlowField ProjectedEyes::Field(const Pose& from, const Pose& to, std::int64_t frame,
                               Side camera) const {
  SeededRandom random(
      Mix(options_.seed, static_cast<std::uint64_t>(frame), static_cast<std::uint64_t>(camera)));
  const double dark = std::clamp(1 - options_.light, 0.0, 0.9);
  const double missing = options_.missing + 0.5 * dark * (1 - options_.missing);
  const double noise_px = options_.noise_px / (1 - dark);
  const View before = cameras_->ViewAt(from, camera);
  const View now = cameras_->ViewAt(to, camera);
  const double route_m = cameras_->route().Nearest(to.position);
  FlowField field{.width = kWidth, .height = kHeight, .vectors = {}};
  std::array<bool, std::size_t{kColumns} * kRows> taken{};
  const auto noisy = [&](double value) {
    return static_cast<float>(value + noise_px * random.Gaussian());
  };
  auto corner = std::ranges::lower_bound(corners_, route_m - kReachM, {}, &Corner::route_m);
  for (; corner != corners_.end() && corner->route_m < route_m + kReachM; ++corner) {
    const Vector3 a = before.camera().FromWorld(corner->place);
    const Vector3 b = now.camera().FromWorld(corner->place);
    if (a[2] < 0.3 || b[2] < 0.3) continue;
    const Ray from_ray{a[0] / a[2], a[1] / a[2]};
    const Ray to_ray{b[0] / b[2], b[1] / b[2]};
    const double x = from_ray.x * Simulator::kFocal + Simulator::kCenterX;
    const double y = from_ray.y * Simulator::kFocal + Simulator::kCenterY;
    const double end_x = to_ray.x * Simulator::kFocal + Simulator::kCenterX;
    const double end_y = to_ray.y * Simulator::kFocal + Simulator::kCenterY;
    if (!Inside(x, y) || !Inside(end_x, end_y)) continue;
    const int row = static_cast<int>(y) / kCellPx;
    const int column = static_cast<int>(x) / kCellPx;
    bool& cell = taken[static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column)];
    if (cell || random.Chance(missing)) continue;
    if (before.NearestDepth(from_ray) < a[2] * 0.98 || now.NearestDepth(to_ray) < b[2] * 0.98) {
      continue;
    }
    cell = true;
    field.vectors.push_back({noisy(x), noisy(y), noisy(end_x), noisy(end_y)});
  }
  const auto clutter = std::lround(options_.clutter * static_cast<double>(field.vectors.size()));
  for (long i = 0; i < clutter; ++i) {
    const double x = random.Uniform(10, kWidth - 10);
    const double y = random.Uniform(10, kHeight - 10);
    field.vectors.push_back({static_cast<float>(x), static_cast<float>(y),
                             static_cast<float>(x + random.Uniform(-8, 8)),
                             static_cast<float>(y + random.Uniform(-2, 2))});
  }
  return field;
}

Observation ProjectedEyes::See(const Pose& robot, std::int64_t frame) {
  Observation seen;
  const Pose from = reference_.value_or(robot);
  std::array<std::optional<FlowField>, 2> fields;
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    fields[static_cast<std::size_t>(camera)] = Field(from, robot, frame, camera);
  }
  if (!reference_ || HasMoved(fields).value_or(true)) reference_ = robot;
  for (std::size_t i = 0; i < fields.size(); ++i) seen.views[i] = *std::move(fields[i]);
  return seen;
}

}  // namespace homing::client
