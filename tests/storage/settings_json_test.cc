#include "storage/settings_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

TEST(SettingsJson, ReadsBackToTheSameBits) {
  for (const JourneySettings& settings : {JourneySettings(), OddSettings()}) {
    const auto read = JourneySettingsFromJson(ToJson(settings));
    ASSERT_THAT(read, IsOk());
    EXPECT_TRUE(*read == settings);
    EXPECT_EQ(ToJson(*read), ToJson(settings));
  }
}

TEST(SettingsJson, LensesOfOtherModelsAreKept) {
  JourneySettings settings = OddSettings();
  // Files of before have five values and no model.
  const std::string before = ToJson(settings);
  EXPECT_EQ(before.find("fisheye"), std::string::npos);
  settings.cameras[0].distortion[7] = 0.0625;
  settings.cameras[1].fisheye = true;
  const auto read = JourneySettingsFromJson(ToJson(settings));
  ASSERT_THAT(read, IsOk());
  EXPECT_TRUE(*read == settings);
}

TEST(SettingsJson, IsCanonical) {
  const std::string text = ToJson(TrainingOptions());
  EXPECT_EQ(text.find(' '), std::string::npos);
  EXPECT_LT(text.find("\"distance_mean_m\""), text.find("\"focal_px\""));
  EXPECT_LT(text.find("\"seed\""), text.find("\"width\""));
}

TEST(SettingsJson, EverySettingIsKept) {
  // Fails to compile when a struct gains a field: add it to settings_json.cc as well.
  [[maybe_unused]] const auto& [f1, f2, f3, f4, f5, f6, f7, f8, f9] = FlowOptions();
  [[maybe_unused]] const auto& [l1, l2, l3, l4, l5, l6, l7] = LandmarkOptions();
  [[maybe_unused]] const auto& [d1, d2, d3, d4, d5, d6] = DeviationModel();
  [[maybe_unused]] const auto& [t1, t2, t3, t4, t5, t6, t7, t8, t9, t10, t11, t12, t13] =
      TrainingOptions();
  TrainingOptions options;
  options.seed = std::numeric_limits<std::uint64_t>::max();
  options.lateral_offset_m = 0.1;
  const auto read = TrainingOptionsFromJson(ToJson(options));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->seed, options.seed);
  EXPECT_EQ(read->lateral_offset_m, 0.1);
}

TEST(SettingsJson, UnexpectedJsonIsDataLoss) {
  for (const char* text : {"", "{", "[]", "{\"flow\":{}}", "null", "{\"left_camera\":3}"}) {
    EXPECT_THAT(JourneySettingsFromJson(text),
                StatusIs(absl::StatusCode::kDataLoss, HasSubstr("settings of a journey")));
  }
  EXPECT_THAT(NamesFromJson("{\"a\":1}"), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("")));
}

}  // namespace
}  // namespace homing::storage
