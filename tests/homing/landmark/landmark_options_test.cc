#include "homing/landmark/landmark_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

struct BadOption {
  std::string name;
  void (*spoil)(LandmarkOptions&);
};

class BadLandmarkOptionTest : public ::testing::TestWithParam<BadOption> {};

TEST_P(BadLandmarkOptionTest, IsNamed) {
  LandmarkOptions options;
  ASSERT_THAT(Validate(options), IsOk());
  GetParam().spoil(options);
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().name + ": ")));
}

using O = LandmarkOptions;
INSTANTIATE_TEST_SUITE_P(
    All, BadLandmarkOptionTest,
    ::testing::Values(BadOption{"min_vector_length_px", [](O& o) { o.min_vector_length_px = -1; }},
                      BadOption{"min_vectors", [](O& o) { o.min_vectors = 0; }},
                      BadOption{"histogram_bins", [](O& o) { o.histogram_bins = 3; }},
                      BadOption{"max_valley_ratio", [](O& o) { o.max_valley_ratio = 1.01; }},
                      BadOption{"min_peak_share", [](O& o) { o.min_peak_share = 0; }},
                      BadOption{"max_track_distance_px",
                                [](O& o) { o.max_track_distance_px = std::nan(""); }},
                      BadOption{"max_track_gap_steps", [](O& o) { o.max_track_gap_steps = 21; }}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace homing
