// Flow vectors through the recorder, the export file and the localiser. Input: observations, each a
// byte of flags (1 left camera, 2 right camera, 4 break before), then for each camera the number of
// vectors and four floats a vector; the image is 320 x 240, or as two numbers say (flag 8).
#include "homing/journey/journey_recorder.h"
#include "homing/localization/localizer.h"
#include "proto/wire/observation_conversion.h"
#include "server/service/journey_archive.h"
#include "tests/fuzz/fuzz_input.h"

namespace homing::fuzz {
namespace {

constexpr int kMostObservations = 64;

void TakeField(FuzzInput* input, int width, int height, v1::FlowVectors* flow) {
  flow->set_width(width);
  flow->set_height(height);
  const int count = input->Take<std::uint8_t>();
  for (int i = 0; i < count && !input->empty(); ++i) {
    flow->add_start_x(input->Take<float>());
    flow->add_start_y(input->Take<float>());
    flow->add_end_x(input->Take<float>());
    flow->add_end_y(input->Take<float>());
  }
}

v1::Observation TakeObservation(FuzzInput* input, std::int64_t sequence) {
  v1::Observation observation;
  observation.set_sequence(sequence);
  const auto flags = input->Take<std::uint8_t>();
  const int width = (flags & 8) != 0 ? input->Take<std::int16_t>() : 320;
  const int height = (flags & 8) != 0 ? input->Take<std::int16_t>() : 240;
  observation.set_break_before((flags & 4) != 0);
  if ((flags & 1) != 0) {
    TakeField(input, width, height, observation.mutable_left()->mutable_flow_vectors());
  }
  if ((flags & 2) != 0) {
    TakeField(input, width, height, observation.mutable_right()->mutable_flow_vectors());
  }
  return observation;
}

// A recording must come back from its file to the bit.
void RequireRoundTrip(const JourneyMap& map) {
  const auto file = server::EncodeJourney({}, map);
  Require(file.ok());
  const auto read = server::DecodeJourney(*file);
  Require(read.ok() && server::EncodeJourney(read->record, read->map).value_or("") == *file);
}

void Run(FuzzInput input) {
  JourneyRecorder recorder{JourneySettings{}};
  JourneyMap map;
  const std::string name = "robots/a/journeys/b";
  const JourneyRef journey{&name, &map};
  LocalizerOptions options;
  options.travel = Travel::kSame;
  Localizer localizer(options);
  for (int i = 0; i < kMostObservations && !input.empty(); ++i) {
    const v1::Observation message = TakeObservation(&input, i);
    const auto observation = wire::FromProto(message);
    if (!observation.ok()) continue;
    const auto step = recorder.Record(*observation);
    if (step.ok() && *step) Require(map.Append(**step).ok());
    map.mutable_settings() = recorder.settings();
    const auto localized = localizer.Localize(*observation, {&journey, 1});
    if (localized.ok()) {
      const double probability = localized->position.probability;
      Require(probability >= 0 && probability <= 1.0001);
    }
  }
  RequireRoundTrip(map);
}

}  // namespace
}  // namespace homing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::Run({data, size});
  return 0;
}
