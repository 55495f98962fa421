// The street of worlds.h.
#include <array>
#include <numbers>
#include <utility>

#include "client/simulator/landmark_list.h"
#include "client/simulator/seeded_random.h"
#include "client/simulator/texture_pool.h"
#include "client/simulator/worlds.h"

namespace homing::client {
namespace {

// The few kinds of house that the whole street is made of.
struct FacadeKind {
  Material material;
  double width_m;
  double height_m;
};
constexpr int kFacadeKindCount = 6;

std::array<FacadeKind, kFacadeKindCount> MakeFacadeKinds() {
  const auto kind = [](TextureKind texture, double tile_m, double mean, double contrast,
                       double width_m, double height_m) {
    return FacadeKind{{.texture = texture, .tile_m = tile_m, .mean = mean, .contrast = contrast},
                      width_m,
                      height_m};
  };
  return {kind(kWindows, 6, 130, 90, 9, 8),    kind(kBricks, 3, 110, 60, 7, 7),
          kind(kPlanks, 4, 120, 70, 6, 5),     kind(kBands, 5, 125, 60, 8, 9),
          kind(kValueNoise, 6, 140, 35, 7, 6), kind(kWindows, 4.5, 110, 80, 7, 9)};
}

class StreetSide {
 public:
  StreetSide(const Route& route, std::uint64_t seed, Side side,
             std::vector<PlacedLandmark>& landmarks)
      : route_(route),
        key_(Mix(seed, 22, static_cast<std::uint64_t>(side))),
        sign_(side == Side::kLeft ? 1 : -1),
        landmarks_(landmarks) {}

  void Build() {
    BuildFacades();
    BuildPosts();
    BuildParkedBoxes();
  }

 private:
  double End() const { return route_.length_m() + kWorldMarginM; }

  // Runs of one to three houses of a kind, then another kind or a gap.
  void BuildFacades() {
    static const std::array<FacadeKind, kFacadeKindCount> kinds = MakeFacadeKinds();
    SeededRandom random(Mix(key_, 1));
    double route_m = -kWorldMarginM;
    while (route_m < End()) {
      const FacadeKind& kind = kinds[static_cast<std::size_t>(random.Below(kFacadeKindCount))];
      const double distance_m = random.Uniform(6, 7.5);
      for (int house = random.Below(3); house >= 0; --house) {
        AddFacade(kind, route_m, distance_m);
        route_m += kind.width_m;
      }
      route_m += random.Chance(0.5) ? random.Uniform(1.5, 4) : 0;
    }
  }

  void AddFacade(const FacadeKind& kind, double route_m, double distance_m) {
    const Pose near_end = route_.At(route_m);
    const Pose far_end = route_.At(route_m + kind.width_m);
    const Vector2 from = near_end.At(0, sign_ * distance_m);
    const Vector2 to = far_end.At(0, sign_ * distance_m);
    const Parallelogram front{Raise(from, 0), Raise(to - from, 0), {0, 0, kind.height_m}};
    // The side walls that a gap shows.
    const Vector3 back = Raise(6 * sign_ * near_end.Left(), 0);
    landmarks_.push_back(
        {route_m + kind.width_m / 2,
         ShapesAsList(front, Parallelogram{front.corner, back, front.edge_v},
                      Parallelogram{front.corner + front.edge_u, back, front.edge_v}),
         kind.material});
  }

  void BuildPosts() {
    SeededRandom random(Mix(key_, 2));
    for (double route_m = -kWorldMarginM; route_m < End(); route_m += random.Uniform(6, 16)) {
      const Vector2 foot = route_.At(route_m).At(0, sign_ * random.Uniform(3, 4));
      const Material material{.texture = random.Below(kTextureCount),
                              .tile_m = random.Uniform(0.6, 1.2),
                              .mean = random.Uniform(50, 160),
                              .contrast = 60};
      landmarks_.push_back(
          {route_m,
           ShapesAsList(Cylinder{foot, random.Uniform(0.08, 0.25), 0, random.Uniform(3, 6)}),
           material});
    }
  }

  void BuildParkedBoxes() {
    SeededRandom random(Mix(key_, 3));
    for (double route_m = -kWorldMarginM; route_m < End();
         route_m += random.Chance(0.4) ? random.Uniform(4.8, 6) : random.Uniform(8, 18)) {
      Pose frame = route_.At(route_m);
      frame.position = frame.At(0, sign_ * random.Uniform(4.2, 4.8));
      const Material material{.texture = random.Below(kTextureCount),
                              .tile_m = random.Uniform(1, 2.5),
                              .offset = {random.Uniform(0, 1), random.Uniform(0, 1)},
                              .mean = random.Uniform(70, 150),
                              .contrast = random.Uniform(40, 90)};
      const BoxSize size{random.Uniform(1.5, 4.4), random.Uniform(0.8, 1.7),
                         random.Uniform(0.9, 1.9)};
      const auto walls = BoxWalls(frame, size);
      std::vector<Shape> shapes(walls.begin(), walls.end());
      landmarks_.push_back({route_m, std::move(shapes), material});
    }
  }

  const Route& route_;
  std::uint64_t key_;
  double sign_;
  std::vector<PlacedLandmark>& landmarks_;
};

}  // namespace

Scene MakeStreetScene(const Route& route, std::uint64_t seed, double remove) {
  std::vector<PlacedLandmark> landmarks;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    StreetSide(route, seed, side, landmarks).Build();
  }
  const Material ground{.texture = kValueNoise, .tile_m = 4, .mean = 100, .contrast = 16};
  const Material skyline{.texture = kMosaic, .tile_m = 40, .mean = 130, .contrast = 30};
  return {Numbered(std::move(landmarks), seed, remove), ground, skyline, 200};
}

}  // namespace homing::client
