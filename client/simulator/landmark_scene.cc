// The world of landmarks of worlds.h.
#include <cmath>
#include <numbers>
#include <utility>

#include "client/simulator/landmark_list.h"
#include "client/simulator/seeded_random.h"
#include "client/simulator/texture_pool.h"
#include "client/simulator/worlds.h"

namespace homing::client {
namespace {

enum class Kind { kSphere, kRoundTower, kSquareTower, kBoard, kBlock, kHill };
constexpr int kKindCount = 6;

Material AnyMaterial(SeededRandom& random) {
  return {.texture = random.Below(kTextureCount),
          .tile_m = random.Uniform(1.5, 4),
          .offset = {random.Uniform(0, 1), random.Uniform(0, 1)},
          .mean = random.Uniform(90, 140),
          .contrast = random.Uniform(60, 100)};
}

std::vector<Shape> Box(const Pose& frame, const BoxSize& size) {
  const auto walls = BoxWalls(frame, size);
  return {walls.begin(), walls.end()};
}

// A leaning parallelogram on the ground, turned about.
Parallelogram Board(const Pose& frame, SeededRandom& random) {
  const double length_m = random.Uniform(1.5, 3.5);
  const double along_m = random.Uniform(-0.8, 0.8);
  const double left_m = random.Uniform(-0.3, 0.3);
  const Vector2 slant = along_m * frame.Along() + left_m * frame.Left();
  return Parallelogram{Raise(frame.At(-length_m / 2, 0), 0), Raise(length_m * frame.Along(), 0),
                       Raise(slant, random.Uniform(1.2, 3))};
}

std::vector<Shape> ShapesOf(Kind kind, const Pose& frame, SeededRandom& random) {
  const Vector2& center = frame.position;
  switch (kind) {
    case Kind::kSphere: {
      const double radius = random.Uniform(0.7, 1.5);
      return ShapesAsList(
          Ellipsoid{Raise(center, radius), {radius, radius, radius}, frame.heading});
    }
    case Kind::kRoundTower:
      return ShapesAsList(Cylinder{center, random.Uniform(0.35, 0.9), 0, random.Uniform(2.5, 6)});
    case Kind::kSquareTower: {
      const double side_m = random.Uniform(0.7, 1.6);
      return Box(frame, {side_m, side_m, random.Uniform(2.5, 6)});
    }
    case Kind::kBoard:
      return ShapesAsList(Board(frame, random));
    case Kind::kBlock:
      return Box(frame, {random.Uniform(1.5, 4), random.Uniform(1, 2), random.Uniform(0.8, 2)});
    case Kind::kHill:
      break;
  }
  const Vector3 half_axes{random.Uniform(1, 2), random.Uniform(1.5, 4), random.Uniform(0.8, 2.2)};
  return ShapesAsList(Ellipsoid{Raise(center, 0), half_axes, frame.heading});
}

// The landmark's own frame: its heading looks at the route, turned a little.
Pose FrameOf(const Pose& at, Kind kind, Side side, double distance_m, SeededRandom& random) {
  const double sign = side == Side::kLeft ? 1 : -1;
  const double turn = random.Uniform(-0.5, 0.5);
  const bool is_round = kind == Kind::kSphere || kind == Kind::kHill;
  const double facing = is_round ? at.heading - sign * std::numbers::pi / 2 : at.heading;
  return {at.At(0, sign * distance_m), facing + turn};
}

// Hills keep their own half axis further off, so that the robot does not drive through them.
PlacedLandmark Place(const Route& route, double route_m, Side side, SeededRandom& random) {
  const auto kind = static_cast<Kind>(random.Below(kKindCount));
  const double nearest_m = kind == Kind::kHill ? 6 : 3.5;
  const double distance_m = nearest_m + (15 - nearest_m) * std::pow(random.Uniform(0, 1), 1.5);
  const Pose frame = FrameOf(route.At(route_m), kind, side, distance_m, random);
  std::vector<Shape> shapes = ShapesOf(kind, frame, random);
  return {route_m, std::move(shapes), AnyMaterial(random)};
}

}  // namespace

RouteBend BendOf(std::uint64_t seed) {
  SeededRandom random(Mix(seed, 55));
  return {random.Uniform(0, 0.08), random.Uniform(80, 140),
          random.Uniform(0, 2 * std::numbers::pi)};
}

Scene MakeLandmarkScene(const Route& route, std::uint64_t seed, double remove) {
  std::vector<PlacedLandmark> landmarks;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    SeededRandom random(Mix(seed, 11, static_cast<std::uint64_t>(side)));
    double route_m = -kWorldMarginM;
    while (route_m < route.length_m() + kWorldMarginM) {
      landmarks.push_back(Place(route, route_m, side, random));
      route_m += random.Chance(0.15) ? random.Uniform(8, 14) : random.Uniform(3.5, 7);
    }
  }
  const Material ground{.texture = kValueNoise, .tile_m = 5, .mean = 95, .contrast = 8};
  const Material skyline{.texture = kMosaic, .tile_m = 40, .mean = 120, .contrast = 30};
  return {Numbered(std::move(landmarks), seed, remove), ground, skyline, 190};
}

}  // namespace homing::client
