#include "proto/wire/settings_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "homing/base/field_error.h"
#include "tests/support/status_matchers.h"

namespace homing::wire {
namespace {

using ::testing::HasSubstr;

// Unlike the defaults in every field.
JourneySettings OddSettings() {
  JourneySettings settings;
  settings.cameras[0] = {.width = 320,
                         .height = 240,
                         .intrinsics = Intrinsics{277.1, 276.9, 160.25, 119.75},
                         .distortion = {0.1, -0.02, 0.001, 1e-17, 1.0 / 3},
                         .yaw_rad = -0.05};
  settings.cameras[1].width = 640;
  settings.cameras[1].height = 480;
  settings.flow = {.working_width_px = 300,
                   .smoothing_sigma_px = 0.7,
                   .normalization_window_px = 27,
                   .normalization_floor = 3.5,
                   .min_eigenvalue = 0.011,
                   .cell_px = 9,
                   .window_px = 13,
                   .pyramid_levels = 2,
                   .max_forward_backward_px = 0.6};
  settings.landmark = {.min_vector_length_px = 0.4,
                       .min_vectors = 7,
                       .histogram_bins = 20,
                       .max_valley_ratio = 0.45,
                       .min_peak_share = 1.0 / 7,
                       .max_track_distance_px = 21,
                       .max_track_gap_steps = 3};
  settings.deviation_model_name = "deviationModels/wide";
  return settings;
}

TEST(SettingsConversion, EverySettingComesBack) {
  const JourneySettings settings = OddSettings();
  const auto back = FromProto(ToProto(settings), "settings", JourneySettings());
  ASSERT_THAT(back, IsOk());
  EXPECT_TRUE(*back == settings);
}

TEST(SettingsConversion, OtherLensModelsRoundTrip) {
  Camera rational = OddSettings().cameras[0];
  rational.distortion[7] = 0.0625;
  EXPECT_EQ(ToProto(rational).distortion_size(), 8);
  Camera fisheye = OddSettings().cameras[0];
  fisheye.fisheye = true;
  fisheye.distortion = {0.1, -0.02, 0.001, 1e-17};
  EXPECT_EQ(ToProto(fisheye).distortion_size(), 4);
  for (const Camera& camera : {rational, fisheye}) {
    const auto back = FromProto(ToProto(camera), "camera");
    ASSERT_THAT(back, IsOk());
    EXPECT_EQ(*back, camera);
  }
  v1::Camera five = ToProto(fisheye);
  five.add_distortion(0);
  EXPECT_THAT(FromProto(five, "camera"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("must be 0 or 4 entries")));
}

TEST(SettingsConversion, UnsetFieldsHaveTheDefaults) {
  const JourneySettings defaults = OddSettings();
  const auto settings = FromProto(v1::JourneySettings(), "settings", defaults);
  ASSERT_THAT(settings, IsOk());
  EXPECT_TRUE(*settings == defaults);
}

TEST(SettingsConversion, ACameraWithoutIntrinsicsWorksInRawPixels) {
  v1::Camera message;
  message.set_width(320);
  message.set_height(240);
  const auto camera = FromProto(message, "camera");
  ASSERT_THAT(camera, IsOk());
  EXPECT_FALSE(camera->intrinsics.has_value());
  EXPECT_EQ(camera->width, 320);
}

// The settings of OddSettings() after `change` are refused, and `why` is in the message.
template <typename Change>
void ExpectSettingsRefused(Change change, const std::string& why) {
  v1::JourneySettings message = ToProto(OddSettings());
  change(message);
  EXPECT_THAT(FromProto(message, "settings", JourneySettings()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
}

TEST(SettingsConversion, ARefusalNamesItsFieldForPrograms) {
  v1::JourneySettings message = ToProto(OddSettings());
  const auto field = [&] {
    return FieldOf(FromProto(message, "settings", JourneySettings()).status());
  };
  message.mutable_left_camera()->set_yaw_rad(3);
  EXPECT_EQ(field(), "settings.left_camera.yaw_rad");
  message.mutable_left_camera()->set_yaw_rad(0);
  message.mutable_flow()->set_window_px(16);
  EXPECT_EQ(field(), "settings.flow.window_px");
}

TEST(SettingsConversion, RefusesWrongSettingsByName) {
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_left_camera()->set_width(-1); },
                        "settings.left_camera.width: -1 must be in [0, 8192] px");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_right_camera()->set_height(8193); },
                        "settings.right_camera.height: 8193");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_left_camera()->add_distortion(1); },
                        "settings.left_camera.distortion: 6 must be 0, 4, 5 or 8 entries");
  ExpectSettingsRefused(
      [](v1::JourneySettings& m) { m.mutable_left_camera()->set_distortion(0, NAN); },
      "settings.left_camera.distortion: nan");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_left_camera()->set_yaw_rad(3); },
                        "yaw_rad");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_right_camera()->set_yaw_rad(0.1); },
                        "yaw_rad");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_flow()->set_window_px(14); },
                        "window_px");
  ExpectSettingsRefused([](v1::JourneySettings& m) { m.mutable_flow()->set_min_eigenvalue(NAN); },
                        "min_eigenvalue");
  ExpectSettingsRefused(
      [](v1::JourneySettings& m) { m.mutable_landmark()->set_min_peak_share(0.6); },
      "min_peak_share");
}

}  // namespace
}  // namespace homing::wire
