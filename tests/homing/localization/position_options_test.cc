#include "homing/localization/position_filter.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

TEST(PositionOptionsTest, NamesTheOptionThatIsOutOfRange) {
  EXPECT_THAT(Validate(PositionOptions{}), IsOk());
  PositionOptions options;
  options.tolerance_steps = -1;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tolerance_steps: -1")));
  options = {};
  options.match_probability = 0;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("match_probability: 0")));
  options = {};
  options.unknown_probability = 1.5;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("unknown_probability")));
  options = {};
  options.likelihood.floor = 0;
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("floor")));
}

}  // namespace
}  // namespace homing
