#include "client/load/load_scene.h"

#include <random>

#include "client/frame_source.h"
#include "homing/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
// Steps for which a landmark is in view.
constexpr int kStepsInView = 25;
constexpr char kFrames[] = "sim:street,length=40";

// One landmark at a time, drifting from right to left at a speed of its own.
FlowField FlowAt(int route, int step, int vectors) {
  const int landmark = step / kStepsInView;
  std::mt19937 drawn(static_cast<std::uint32_t>(route * 100'003 + landmark));
  std::uniform_real_distribution<float> place(150, 330);
  std::uniform_real_distribution<float> part(0.4F, 1.0F);
  const float y = place(drawn);
  const auto seen = static_cast<int>(part(drawn) * static_cast<float>(vectors));
  const float x = 560 - static_cast<float>(step % kStepsInView) * 19;
  std::mt19937 noise(static_cast<std::uint32_t>(step));
  std::uniform_real_distribution<float> spread(-40, 40);
  FlowField field{kWidth, kHeight, {}};
  for (int i = 0; i < vectors; ++i) {
    const float from_x = x + spread(noise);
    const float from_y = y + spread(noise);
    // The others are too short to count.
    const float length = i < seen ? 4 : 0.05F;
    field.vectors.push_back({from_x, from_y, from_x - length, from_y});
  }
  return field;
}

}  // namespace

LoadScene LoadScene::WithFlow(int route, int steps, int vectors) {
  LoadScene scene;
  for (int step = 0; step < steps; ++step) {
    Observation observation;
    observation.views[0] = FlowAt(route, step, vectors);
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
