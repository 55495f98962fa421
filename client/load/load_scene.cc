#include "client/load/load_scene.h"

#include <utility>

#include "client/frame_source.h"
#include "client/load/projected_drive.h"
#include "client/simulator/seeded_random.h"
#include "homing/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

constexpr char kFrames[] = "sim:street,length=40";
constexpr double kStepM = 4 / 3.6 / 5;
// Too short to count.
constexpr float kStillPx = 0.05F;

// What is seen fills the message to `vectors`, or is thinned out to them.
void SetCount(int vectors, SeededRandom& random, FlowField& field) {
  const auto count = static_cast<std::size_t>(vectors);
  while (field.vectors.size() > count) {
    field.vectors[static_cast<std::size_t>(random.Below(static_cast<int>(field.vectors.size())))] =
        field.vectors.back();
    field.vectors.pop_back();
  }
  while (field.vectors.size() < count) {
    const auto x = static_cast<float>(random.Uniform(1, field.width - 1));
    const auto y = static_cast<float>(random.Uniform(0, field.height));
    field.vectors.push_back({x, y, x - kStillPx, y});
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
    SetCount(vectors, random, field);
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

void LoadScene::Fill(std::int64_t sequence, v1::Observation* observation) const {
  *observation = observations_[static_cast<std::size_t>(sequence) % observations_.size()];
  observation->set_sequence(sequence);
}

}  // namespace homing::client
