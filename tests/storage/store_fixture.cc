#include "tests/storage/store_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/support/postgres_server.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {

void EveryStore::SetUp() {
  std::string url = "sqlite::memory:";
  if (GetParam() == StoreKind::kFile) url = folder_.Database();
  if (GetParam() == StoreKind::kPostgres) {
    std::string reason;
    test::PostgresServer* const server = test::PostgresServer::Shared(&reason);
    if (server == nullptr) GTEST_SKIP() << "SKIPPED: " << reason;
    url = server->NewDatabase();
  }
  store_ = OpenOrDie(url);
}

std::string KindName(const ::testing::TestParamInfo<StoreKind>& test) {
  if (test.param == StoreKind::kPostgres) return "Postgres";
  return test.param == StoreKind::kFile ? "File" : "Memory";
}

std::unique_ptr<JourneyStore> OpenOrDie(const std::string& url, std::int64_t max_bytes) {
  StoreOptions options;
  options.url = url;
  options.max_bytes = max_bytes;
  auto store = OpenJourneyStore(options);
  if (!store.ok()) ADD_FAILURE() << store.status();
  return std::move(store).value();
}

JourneySettings OddSettings() {
  JourneySettings settings;
  settings.cameras[0] = {.width = 320,
                         .height = 240,
                         .intrinsics = Intrinsics{277.1, 276.9, 160.25, 119.75},
                         .distortion = {0.1, -0.02, 0.001, 1e-17, 1.0 / 3},
                         .yaw_rad = -0.05};
  settings.cameras[1].width = 640;
  settings.cameras[1].height = 480;
  // In full: schema/v1.sql holds these values, whatever the defaults become.
  settings.flow = {.working_width_px = 320,
                   .smoothing_sigma_px = 0.1 + 0.2,
                   .normalization_window_px = 31,
                   .normalization_floor = 4,
                   .min_eigenvalue = 0.003,
                   .cell_px = 9,
                   .window_px = 15,
                   .pyramid_levels = 3,
                   .max_forward_backward_px = 0.5};
  settings.landmark = {.min_vector_length_px = 0.5,
                       .min_vectors = 8,
                       .histogram_bins = 16,
                       .max_valley_ratio = 0.5,
                       .min_peak_share = 1.0 / 7,
                       .max_track_distance_px = 20,
                       .max_track_gap_steps = 3};
  settings.deviation_model_name = "deviationModels/wide \"quoted\"";
  settings.deviation_model = {2.2400000000000002, 0.86, 1000, 0.0123, 320, 240};
  return settings;
}

JourneyRecord Record(const std::string& name) {
  JourneyRecord record;
  record.name = name;
  record.settings = OddSettings();
  record.writer_id = "writer";
  record.readers = {"robots/a", "*"};
  record.create_time_ns = 1'700'000'000'123'456'789;
  return record;
}

std::uint32_t StepMaker::Random() {
  random_ = random_ * 1664525U + 1013904223U;
  return random_ >> 8U;
}

JourneyStep StepMaker::Next() {
  JourneyStep step;
  step.step = step_++;
  // Two, three, four fingerprints in turn; a lane left out ends its landmark.
  const int lanes = 2 + static_cast<int>(step.step / 5 % 3);
  const bool used[4] = {true, lanes >= 3, true, lanes >= 4};
  for (int i = 0; i < 4; ++i) {
    Lane& lane = lanes_[i];
    if (!used[i]) {
      lane.landmark = -1;
      continue;
    }
    if (lane.landmark < 0 || Random() % static_cast<std::uint32_t>(landmark_steps_) == 0) {
      lane.landmark = landmarks_++;
    }
    RecordedFingerprint recorded;
    recorded.side = i < 2 ? Side::kLeft : Side::kRight;
    recorded.spread = static_cast<double>(Random() % 1000) / 997.0;
    recorded.fingerprint = {static_cast<float>((i % 2) * 160) + static_cast<float>(Random()) / 1e6F,
                            static_cast<float>(Random()) / 1e5F,
                            static_cast<std::int32_t>(20 + Random() % 200), lane.landmark};
    step.fingerprints.push_back(recorded);
  }
  return step;
}

JourneyAppend AppendOf(const std::string& journey, const JourneyStep& step) {
  JourneyAppend append;
  append.journey = journey;
  append.sequence = step.step;
  append.input = InputKind::kFlowVectors;
  append.capture_time_ns = 1'000'000'000 + step.step;
  append.step = step;
  return append;
}

void AppendAll(JourneyStore& store, const std::string& journey,
               const std::vector<JourneyStep>& steps) {
  for (const JourneyStep& step : steps) {
    const auto statuses = store.AppendSteps({AppendOf(journey, step)});
    ASSERT_EQ(statuses.size(), 1U);
    ASSERT_THAT(statuses[0], IsOk());
  }
}

std::vector<JourneyStep> MakeSteps(int count) {
  StepMaker maker;
  std::vector<JourneyStep> steps;
  for (int i = 0; i < count; ++i) steps.push_back(maker.Next());
  return steps;
}

JourneyMap MapOf(const JourneySettings& settings, const std::vector<JourneyStep>& steps) {
  JourneyMap map(settings);
  for (const JourneyStep& step : steps) EXPECT_THAT(map.Append(step), IsOk());
  return map;
}

std::vector<JourneyStep> WithProfiles(std::vector<JourneyStep> steps) {
  for (JourneyStep& step : steps) {
    for (std::size_t side = 0; side < step.profiles.size() && step.step % 7 != 3; ++side) {
      FlowProfile profile;
      for (std::size_t cell = 0; cell < profile.cells.size(); ++cell) {
        // Two neighbouring columns share their parallax code.
        const auto parallax = static_cast<std::size_t>(step.step) * 3 + cell / 2 + side;
        const auto count = static_cast<std::size_t>(step.step) * 5 + cell;
        profile.cells[cell] = static_cast<std::uint8_t>((parallax & 15) << 4 | (count & 15));
      }
      profile.odometer = {.median_x = static_cast<std::int16_t>(step.step - 25),
                          .expansion = static_cast<std::int16_t>(7 * step.step),
                          .length_code = static_cast<std::uint8_t>(1 + step.step % 200),
                          .spread_code = static_cast<std::uint8_t>(1 + step.step % 99)};
      step.profiles[side] = profile;
    }
  }
  return steps;
}

bool SameMap(const JourneyMap& a, const JourneyMap& b) {
  if (!(a.settings() == b.settings()) || a.step_count() != b.step_count()) return false;
  for (std::int64_t step = 0; step < a.step_count(); ++step) {
    if (!std::ranges::equal(a.fingerprints(step), b.fingerprints(step))) return false;
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (!std::ranges::equal(a.profiles(side), b.profiles(side))) return false;
  }
  return a.landmarks() == b.landmarks();
}

}  // namespace homing::storage
