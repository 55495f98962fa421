#include "client/bench/load_scene.h"

#include <gtest/gtest.h>

#include "homing/journey/journey_recorder.h"
#include "homing/localization/localizer.h"
#include "proto/wire/observation_conversion.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

constexpr int kSteps = 60;
constexpr int kVectors = 200;

Observation ObservationAt(const LoadScene& scene, std::int64_t sequence) {
  v1::Observation message = scene.observations().at(static_cast<std::size_t>(sequence));
  message.set_sequence(sequence);
  const auto observation = wire::FromProto(message, {});
  EXPECT_THAT(observation, IsOk());
  return *observation;
}

TEST(LoadSceneTest, HasTheNumberOfVectorsThatIsAskedFor) {
  for (const int vectors : {0, 10, kVectors, 500}) {
    const LoadScene scene = LoadScene::WithFlow(0, 1, 2, vectors);
    EXPECT_EQ(scene.observations().at(1).left().flow_vectors().start_x_size(), vectors);
  }
}

TEST(LoadSceneTest, AnotherDriveAlongARouteFindsItsPlaceOnTheFirst) {
  const LoadScene out = LoadScene::WithFlow(0, 1, kSteps, kVectors);
  const LoadScene second = LoadScene::WithFlow(0, 2, kSteps, kVectors);
  JourneyRecorder recorder{JourneySettings()};
  JourneyMap map;
  for (int i = 0; i < kSteps; ++i) {
    const auto step = recorder.Record(ObservationAt(out, i));
    ASSERT_THAT(step, IsOk());
    ASSERT_TRUE(step->has_value());
    ASSERT_THAT(map.Append(**step), IsOk());
  }
  map.mutable_settings() = recorder.settings();
  const std::string name = "robots/a/journeys/b";
  const JourneyRef journey{&name, &map};
  LocalizerOptions options;
  options.travel = Travel::kSame;
  Localizer localizer(options);
  Position position;
  for (int i = 0; i < kSteps; ++i) {
    const auto answer = localizer.Localize(ObservationAt(second, i), {&journey, 1});
    ASSERT_THAT(answer, IsOk());
    position = answer->position;
  }
  EXPECT_NE(position.outcome, Outcome::kUnknownPlace);
  EXPECT_NEAR(static_cast<double>(*position.step), kSteps - 1, 2);
}

}  // namespace
}  // namespace homing::client
