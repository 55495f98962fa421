#include "homing/flow/flow_tracker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "homing/flow/median.h"
#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

double MedianOf(const FlowField& field, double (FlowVector::*component)() const) {
  std::vector<float> values;
  for (const FlowVector& v : field.vectors) {
    values.push_back(static_cast<float>((v.*component)()));
  }
  return Median(values);
}

struct Translation {
  int width;
  int height;
  double u;
  double v;
};

class TranslationTest : public ::testing::TestWithParam<Translation> {};

// Equations 1 to 5: brightness moves with the texture, so A^T A d = A^T b gives its translation.
TEST_P(TranslationTest, TranslatedTextureGivesTheTranslation) {
  const auto [width, height, u, v] = GetParam();
  const FlowField field =
      FlowOf(TexturePicture(width, height, 0, 0), TexturePicture(width, height, u, v));
  ASSERT_GT(field.vectors.size(), 20U);
  EXPECT_NEAR(MedianOf(field, &FlowVector::FlowX), u, 0.05);
  EXPECT_NEAR(MedianOf(field, &FlowVector::FlowY), v, 0.05);
  std::vector<float> misses;
  for (const FlowVector& vector : field.vectors) {
    misses.push_back(static_cast<float>(std::hypot(vector.FlowX() - u, vector.FlowY() - v)));
  }
  EXPECT_LT(Median(misses), 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, TranslationTest,
    ::testing::Values(Translation{160, 120, 1, 0}, Translation{160, 120, -2.5, 0.75},
                      Translation{320, 240, 0, 0}, Translation{320, 240, 0.3, -0.2},
                      Translation{320, 240, 3.25, 1.5}, Translation{320, 240, -12, 4},
                      Translation{640, 480, 5.5, -2}, Translation{500, 333, 4, 0}));

// Equations 4, 5: A^T A is singular on an edge and where there is nothing, so there is no vector.
TEST(FlowTrackerTest, BlankWallGivesNoVector) {
  const cv::Mat wall(240, 320, CV_8UC1, cv::Scalar(110));
  EXPECT_THAT(FlowOf(wall, wall).vectors, IsEmpty());
}

TEST(FlowTrackerTest, PureEdgeGivesNoVector) {
  cv::Mat before(240, 320, CV_8UC1, cv::Scalar(50));
  cv::Mat now = before.clone();
  before.colRange(150, 320).setTo(200);
  now.colRange(153, 320).setTo(200);
  EXPECT_THAT(FlowOf(before, now).vectors, IsEmpty());
  EXPECT_THAT(FlowOf(before.t(), now.t()).vectors, IsEmpty());
}

TEST(FlowTrackerTest, TheCornerOfASquareGivesAVector) {
  cv::Mat before(240, 320, CV_8UC1, cv::Scalar(50));
  cv::Mat now = before.clone();
  before(cv::Rect(150, 100, 40, 40)).setTo(200);
  now(cv::Rect(153, 101, 40, 40)).setTo(200);
  const FlowField field = FlowOf(before, now);
  ASSERT_GE(field.vectors.size(), 4U);
  EXPECT_NEAR(MedianOf(field, &FlowVector::FlowX), 3, 0.1);
  EXPECT_NEAR(MedianOf(field, &FlowVector::FlowY), 1, 0.1);
}

TEST(FlowTrackerTest, TheFirstFrameGivesNoField) {
  FlowTracker tracker({});
  EXPECT_FALSE(tracker.Track(TexturePicture(320, 240, 0, 0)).value().has_value());
}

TEST(FlowTrackerTest, TheReferenceStaysUntilItIsAdvanced) {
  FlowTracker tracker({});
  ASSERT_THAT(tracker.Track(TexturePicture(320, 240, 0, 0)), IsOk());
  tracker.Advance();
  for (const double moved : {1.0, 2.0, 3.0}) {
    const auto field = tracker.Track(TexturePicture(320, 240, moved, 0)).value();
    EXPECT_NEAR(MedianOf(*field, &FlowVector::FlowX), moved, 0.05);
  }
  tracker.Advance();
  const auto field = tracker.Track(TexturePicture(320, 240, 4, 0)).value();
  EXPECT_NEAR(MedianOf(*field, &FlowVector::FlowX), 1, 0.05);
}

TEST(FlowTrackerTest, ResetForgetsTheReferenceFrame) {
  FlowTracker tracker({});
  ASSERT_THAT(tracker.Track(TexturePicture(320, 240, 0, 0)), IsOk());
  tracker.Advance();
  tracker.Reset();
  EXPECT_FALSE(tracker.Track(TexturePicture(320, 240, 1, 0)).value().has_value());
}

TEST(FlowTrackerTest, AnotherSizeIsRefusedAndChangesNothing) {
  FlowTracker tracker({});
  ASSERT_THAT(tracker.Track(TexturePicture(320, 240, 0, 0)), IsOk());
  tracker.Advance();
  EXPECT_THAT(tracker.Track(TexturePicture(320, 200, 0, 0)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("320 x 200")));
  const auto field = tracker.Track(TexturePicture(320, 240, 2, 0)).value();
  EXPECT_NEAR(MedianOf(*field, &FlowVector::FlowX), 2, 0.05);
}

TEST(FlowTrackerTest, SameFramesGiveTheSameVectorsEvenFromAnEarlierStart) {
  std::vector<cv::Mat> frames;
  for (int i = 0; i < 4; ++i) {
    frames.push_back(Exposed(TexturePicture(320, 240, 1.3 * i, 0.4 * i), 1, 3, 50U + unsigned(i)));
  }
  FlowTracker whole({});
  std::vector<FlowVector> last;
  for (const cv::Mat& frame : frames) {
    const auto field = whole.Track(frame).value();
    whole.Advance();
    last = field.has_value() ? field->vectors : last;
  }
  ASSERT_GT(last.size(), 50U);
  EXPECT_EQ(FlowOf(frames[2], frames[3]).vectors, last);
}

TEST(FlowTrackerTest, AllVectorsBeginAndEndOnTheImage) {
  for (const cv::Size& size : {cv::Size(16, 16), cv::Size(33, 400), cv::Size(2000, 16)}) {
    const FlowField field = FlowOf(TexturePicture(size.width, size.height, 0, 0),
                                   TexturePicture(size.width, size.height, 4, 3));
    for (const FlowVector& v : field.vectors) {
      EXPECT_GE(std::min({v.start_x, v.end_x, v.start_y, v.end_y}), -0.5F);
      EXPECT_LT(std::max(v.start_x, v.end_x), float(size.width) - 0.5F);
      EXPECT_LT(std::max(v.start_y, v.end_y), float(size.height) - 0.5F);
    }
  }
}

TEST(FlowTrackerTest, NoTwoVectorsBeginNearerThanHalfACell) {
  const FlowField field = FlowOf(TexturePicture(320, 240, 0, 0), TexturePicture(320, 240, 1, 0));
  const FlowOptions options;
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const FlowVector& a = field.vectors[i];
      const FlowVector& b = field.vectors[j];
      EXPECT_GT(std::max(std::abs(a.start_x - b.start_x), std::abs(a.start_y - b.start_y)),
                0.5 * options.cell_px);
    }
  }
}

struct BadOption {
  std::string name;
  void (*spoil)(FlowOptions&);
};

class BadFlowOptionTest : public ::testing::TestWithParam<BadOption> {};

TEST_P(BadFlowOptionTest, IsNamed) {
  FlowOptions options;
  ASSERT_THAT(Validate(options), IsOk());
  GetParam().spoil(options);
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, ::testing::StartsWith(GetParam().name)));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadFlowOptionTest,
    ::testing::Values(BadOption{"working_width_px", [](FlowOptions& o) { o.working_width_px = 8; }},
                      BadOption{"smoothing_sigma_px",
                                [](FlowOptions& o) { o.smoothing_sigma_px = std::nan(""); }},
                      BadOption{"normalization_window_px",
                                [](FlowOptions& o) { o.normalization_window_px = 30; }},
                      BadOption{"normalization_floor",
                                [](FlowOptions& o) { o.normalization_floor = 0; }},
                      BadOption{"min_eigenvalue", [](FlowOptions& o) { o.min_eigenvalue = 0; }},
                      BadOption{"cell_px", [](FlowOptions& o) { o.cell_px = 0; }},
                      BadOption{"cell_px: 1 must be at least 5",
                                [](FlowOptions& o) {
                                  o.working_width_px = 2048;
                                  o.cell_px = 1;
                                }},
                      BadOption{"window_px", [](FlowOptions& o) { o.window_px = 16; }},
                      BadOption{"pyramid_levels", [](FlowOptions& o) { o.pyramid_levels = 7; }},
                      BadOption{"max_forward_backward_px",
                                [](FlowOptions& o) { o.max_forward_backward_px = 5.5; }}),
    [](const auto& bad) { return "Option" + std::to_string(bad.index); });

}  // namespace
}  // namespace homing
