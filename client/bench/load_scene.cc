#include "client/bench/load_scene.h"

#include <utility>

#include "client/bench/projected_drive.h"
#include "client/simulator/seeded_random.h"
#include "client/source/frame_source.h"
#include "homing/base/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

constexpr char kFrames[] = "sim:street,length=40";
constexpr double kStepM = 4 / 3.6 / 5;
// Derives one more corner from a visible one.
constexpr double kBesidePx = 6;

bool IsInside(const FlowField& field, float x, float y) {
  return x >= 0 && x < static_cast<float>(field.width) && y >= 0 &&
         y < static_cast<float>(field.height);
}

// Thins the field out to `count` vectors, or adds corners to it.
void SetCount(std::size_t count, SeededRandom& random, FlowField& field) {
  std::vector<FlowVector>& vectors = field.vectors;
  const auto any = [&] {
    return static_cast<std::size_t>(random.Below(static_cast<int>(vectors.size())));
  };
  while (vectors.size() > count) {
    vectors[any()] = vectors.back();
    vectors.pop_back();
  }
  while (!vectors.empty() && vectors.size() < count) {
    const FlowVector& seen = vectors[any()];
    const auto x = static_cast<float>(random.Uniform(-kBesidePx, kBesidePx));
    const auto y = static_cast<float>(random.Uniform(-kBesidePx, kBesidePx));
    const FlowVector beside{seen.start_x + x, seen.start_y + y, seen.end_x + x, seen.end_y + y};
    if (IsInside(field, beside.start_x, beside.start_y) &&
        IsInside(field, beside.end_x, beside.end_y)) {
      vectors.push_back(beside);
    }
  }
}

}  // namespace

LoadScene LoadScene::WithFlow(int route, int drive, int steps, int vectors) {
  const double length = steps * kStepM;
  const ProjectedWorld world(static_cast<std::uint64_t>(route), length);
  const ProjectedDrive robot(
      &world, {.seed = static_cast<std::uint64_t>(drive), .end_m = length + kStepM / 2});
  SeededRandom random(Mix(static_cast<std::uint64_t>(route), static_cast<std::uint64_t>(drive)));
  LoadScene scene;
  for (int step = 0; step < steps; ++step) {
    FlowField field = *robot.Flow(step).fields[0];
    SetCount(static_cast<std::size_t>(vectors), random, field);
    Observation observation;
    observation.views[0] = std::move(field);
    scene.observations_.push_back(wire::ToProto(observation));
  }
  return scene;
}

absl::StatusOr<LoadScene> LoadScene::WithFrames(int count) {
  HOMING_ASSIGN_OR_RETURN(const auto source, OpenFrameSource(kFrames, Side::kLeft));
  LoadScene scene;
  while (static_cast<int>(scene.observations_.size()) < count) {
    HOMING_ASSIGN_OR_RETURN(const auto frame, source->Next());
    if (!frame) break;
    Observation observation;
    observation.views[0] = frame->view();
    scene.observations_.push_back(wire::ToProto(observation));
  }
  return scene;
}

}  // namespace homing::client
