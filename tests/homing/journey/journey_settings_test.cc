#include "homing/journey/journey_settings.h"

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

TEST(JourneySettingsTest, DefaultsAreValid) { EXPECT_THAT(Validate(JourneySettings{}), IsOk()); }

TEST(JourneySettingsTest, NamesTheOptionThatIsOutOfRange) {
  JourneySettings settings;
  settings.cameras[1].yaw_rad = 7;
  EXPECT_THAT(Validate(settings),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("right_camera")));
  settings = {};
  settings.flow.window_px = 1;
  EXPECT_THAT(Validate(settings),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("window_px")));
  settings = {};
  settings.landmark.histogram_bins = 1;
  EXPECT_THAT(Validate(settings),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("histogram_bins")));
  settings = {};
  settings.deviation_model.sigma = -1;
  EXPECT_THAT(Validate(settings), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("sigma")));
}

TEST(JourneySettingsTest, NamesAModelThatIsNoResource) {
  JourneySettings settings;
  settings.deviation_model_name = "mine";
  EXPECT_THAT(Validate(settings),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("\"mine\"")));
}

}  // namespace
}  // namespace homing
