#include "homing/flow/observation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// Frame `index` of a drive; it owns the bytes that the observation shows.
struct Moment {
  cv::Mat image;
  explicit Moment(int index, int width = 160) : image(TexturePicture(width, 120, 1.5 * index, 0)) {}
  Frame frame() const {
    return {FrameEncoding::kGray8,
            image.cols,
            image.rows,
            {reinterpret_cast<const char*>(image.data), image.total()}};
  }
};

Observation Both(const Moment& left, const Moment& right) {
  return {0, 0, false, {left.frame(), right.frame()}};
}

Observation LeftOnly(const Moment& left) { return {0, 0, false, {left.frame(), std::monostate()}}; }

TEST(ObservationFlowTest, TheSecondFrameGivesFlowOfBothCameras) {
  ObservationFlow flow({});
  const ObservedFlow first = flow.Compute(Both(Moment(0), Moment(0, 200))).value();
  EXPECT_FALSE(first.fields[0].has_value() || first.fields[1].has_value());
  const ObservedFlow second = flow.Compute(Both(Moment(1), Moment(1, 200))).value();
  ASSERT_TRUE(second.fields[0].has_value() && second.fields[1].has_value());
  EXPECT_EQ(second.fields[0]->width, 160);
  EXPECT_EQ(second.fields[1]->width, 200);
  EXPECT_FALSE(second.fields[1]->vectors.empty());
}

TEST(ObservationFlowTest, AnAbsentCameraGivesNoFlowThenNorAtItsNextFrame) {
  ObservationFlow flow({});
  ASSERT_THAT(flow.Compute(Both(Moment(0), Moment(0))), IsOk());
  const ObservedFlow absent = flow.Compute(LeftOnly(Moment(1))).value();
  EXPECT_TRUE(absent.fields[0].has_value());
  EXPECT_FALSE(absent.fields[1].has_value());
  const ObservedFlow back = flow.Compute(Both(Moment(2), Moment(2))).value();
  EXPECT_TRUE(back.fields[0].has_value());
  EXPECT_FALSE(back.fields[1].has_value());
  EXPECT_TRUE(flow.Compute(Both(Moment(3), Moment(3))).value().fields[1].has_value());
}

TEST(ObservationFlowTest, NoFlowSpansABreak) {
  ObservationFlow flow({});
  ASSERT_THAT(flow.Compute(Both(Moment(0), Moment(0))), IsOk());
  Observation after = Both(Moment(1), Moment(1));
  const Moment moment(1);
  after.views = {moment.frame(), moment.frame()};
  after.break_before = true;
  const ObservedFlow none = flow.Compute(after).value();
  EXPECT_FALSE(none.fields[0].has_value() || none.fields[1].has_value());
}

TEST(ObservationFlowTest, AnErrorOfOneCameraLeavesBothAsBefore) {
  ObservationFlow disturbed({});
  ObservationFlow undisturbed({});
  const Moment first(0);
  const Moment second(1);
  ASSERT_THAT(disturbed.Compute(Both(first, first)), IsOk());
  ASSERT_THAT(undisturbed.Compute(Both(first, first)), IsOk());
  const Moment other(5);
  Observation bad = Both(other, other);
  bad.break_before = true;
  std::get<Frame>(bad.views[1]).height = 119;
  EXPECT_THAT(disturbed.Compute(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("right.frame.data: ")));
  const ObservedFlow a = disturbed.Compute(Both(second, second)).value();
  const ObservedFlow b = undisturbed.Compute(Both(second, second)).value();
  ASSERT_TRUE(a.fields[0].has_value() && a.fields[1].has_value());
  EXPECT_EQ(a.fields[0]->vectors, b.fields[0]->vectors);
  EXPECT_EQ(a.fields[1]->vectors, b.fields[1]->vectors);
}

TEST(ObservationFlowTest, AChangedSizeIsRefusedEvenAfterABreak) {
  ObservationFlow flow({});
  const Moment first(0);
  const Moment wider(1, 170);
  ASSERT_THAT(flow.Compute(LeftOnly(first)), IsOk());
  Observation changed = LeftOnly(wider);
  changed.break_before = true;
  EXPECT_THAT(flow.Compute(changed),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("170 x 120 px")));
}

TEST(ObservationFlowTest, NoCameraAtAllIsRefused) {
  ObservationFlow flow({});
  EXPECT_THAT(flow.Compute({}), StatusIs(absl::StatusCode::kInvalidArgument,
                                         HasSubstr("neither a left nor a right view")));
}

Observation OfVectors(FlowField field) {
  return {0, 0, false, {std::move(field), std::monostate()}};
}

TEST(ObservationFlowTest, FlowVectorsArePassedOn) {
  ObservationFlow flow({});
  const FlowField field{160, 120, {{1, 2, 3, 4}, {5, 6, 7, 8}}};
  EXPECT_EQ(flow.Compute(OfVectors(field)).value().fields[0]->vectors, field.vectors);
}

struct BadField {
  FlowField field;
  std::string message;
};

class BadFieldTest : public ::testing::TestWithParam<BadField> {};

TEST_P(BadFieldTest, IsRefusedWithItsReason) {
  ObservationFlow flow({});
  EXPECT_THAT(flow.Compute(OfVectors(GetParam().field)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().message)));
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

INSTANTIATE_TEST_SUITE_P(
    All, BadFieldTest,
    ::testing::Values(
        BadField{{160, 120, {{1, 2, 3, 4}, {1, kNan, 3, 4}}}, "left: flow_vectors[1] "},
        BadField{{160, 120, {{1, 2, kInfinite, 4}}}, "flow_vectors[0] "},
        BadField{{160, 120, {{1, 2, 3, -kInfinite}}}, "flow_vectors[0] "},
        BadField{{160, 120, {{1, 2, 1e6F, 4}}}, "flow_vectors[0] "},
        BadField{{0, 120, {}}, "0 x 120 px"}, BadField{{160, 1 << 30, {}}, "[16, 8192] px"},
        BadField{{160, 120, std::vector<FlowVector>(100001)}, "the limit is 100000"}));

}  // namespace
}  // namespace homing
