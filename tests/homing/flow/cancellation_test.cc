// Nobody waits for the result any more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "homing/base/cancellation.h"
#include "homing/flow/observation.h"
#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// Is cancelled when it is asked for the `at`th time.
class CancelledAt : public Cancellation {
 public:
  explicit CancelledAt(int at) : at_(at) {}
  bool IsCancelled() const override { return ++asked_ >= at_; }
  int asked() const { return asked_; }

 private:
  const int at_;
  mutable int asked_ = 0;
};

Observation Both(const cv::Mat& image) {
  const Frame frame{FrameEncoding::kGray8,
                    image.cols,
                    image.rows,
                    {reinterpret_cast<const char*>(image.data), image.total()}};
  return {0, 0, false, {frame, frame}};
}

TEST(CancellationTest, ItStopsBetweenAnyTwoStagesOfAPairOfFrames) {
  const cv::Mat before = TexturePicture(400, 120, 0, 0);
  const cv::Mat now = TexturePicture(400, 120, 1.5, 0);
  DecodeLimits limits;
  const CancelledAt never(1 << 20);
  limits.cancellation = &never;
  ObservationFlow whole({}, limits);
  ASSERT_THAT(whole.Compute(Both(before)), IsOk());
  const int asked_for_first = never.asked();
  ASSERT_THAT(whole.Compute(Both(now)), IsOk());
  // Of each camera: its decoding, three stages of its frame, its corners there and back.
  EXPECT_GE(never.asked() - asked_for_first, 2 * 6);
  for (int at = 1; at <= never.asked(); ++at) {
    const CancelledAt cancelled(at);
    limits.cancellation = &cancelled;
    ObservationFlow flow({}, limits);
    absl::Status status = flow.Compute(Both(before)).status();
    EXPECT_EQ(status.ok(), at > asked_for_first);
    if (status.ok()) status = flow.Compute(Both(now)).status();
    EXPECT_THAT(status, StatusIs(absl::StatusCode::kCancelled, HasSubstr("does not wait")));
    EXPECT_EQ(cancelled.asked(), at);
  }
}

}  // namespace
}  // namespace homing
