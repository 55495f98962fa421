// Flow against dense truth of real and rendered pairs (Middlebury benchmark, Baker et al. 2011).
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>

#include "homing/flow/median.h"
#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/real_sequences.h"

namespace homing {
namespace {

// The .flo format: a tag, width, height, then u and v of each pixel, all of 4 bytes.
cv::Mat ReadTruth(const std::filesystem::path& file) {
  const std::string bytes = BytesOf(file);
  std::int32_t size[2];
  std::memcpy(size, bytes.data() + 4, sizeof(size));
  cv::Mat truth(size[1], size[0], CV_32FC2);
  std::memcpy(truth.data, bytes.data() + 12, truth.total() * truth.elemSize());
  return truth;
}

class FlowTruthTest : public ::testing::TestWithParam<std::string> {};

TEST_P(FlowTruthTest, MedianEndPointErrorIsUnderHalfAPixel) {
  HOMING_SKIP_WITHOUT("flow_truth/" + GetParam());
  const auto folder = RealSequence("flow_truth/" + GetParam());
  const cv::Mat truth = ReadTruth(folder / "flow10.flo");
  const FlowField field =
      FlowOf(ReadImage(folder / "frame10.png"), ReadImage(folder / "frame11.png"));
  std::vector<float> errors;
  for (const FlowVector& v : field.vectors) {
    const auto exact =
        truth.at<cv::Vec2f>(int(std::lround(v.start_y)), int(std::lround(v.start_x)));
    // Unknown truth is marked by huge values.
    if (std::abs(exact[0]) < 1e3F) {
      errors.push_back(static_cast<float>(
          std::hypot(v.FlowX() - double{exact[0]}, v.FlowY() - double{exact[1]})));
    }
  }
  ASSERT_GT(errors.size(), 50U);
  EXPECT_LT(Median(errors), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Pairs, FlowTruthTest,
                         ::testing::Values("Dimetrodon", "Grove2", "Grove3", "Hydrangea",
                                           "RubberWhale", "Urban2", "Urban3", "Venus"));

}  // namespace
}  // namespace homing
