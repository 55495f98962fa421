#include "homing/flow/observation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "homing/flow/median.h"
#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// Frame `index` of a drive; it owns the bytes that the observation shows.
struct Moment {
  cv::Mat image;
  explicit Moment(double index, int width = 160)
      : image(TexturePicture(width, 120, 1.5 * index, 0)) {}
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

TEST(ObservationFlowTest, ACameraAbsentAtAStepGivesNoFlowUntilTheNext) {
  ObservationFlow flow({});
  ASSERT_THAT(flow.Compute(Both(Moment(0), Moment(0))), IsOk());
  const ObservedFlow absent = flow.Compute(LeftOnly(Moment(1))).value();
  EXPECT_TRUE(absent.makes_step);
  EXPECT_TRUE(absent.fields[0].has_value());
  EXPECT_FALSE(absent.fields[1].has_value());
  const ObservedFlow back = flow.Compute(Both(Moment(2), Moment(2))).value();
  EXPECT_TRUE(back.fields[0].has_value());
  EXPECT_FALSE(back.fields[1].has_value());
  EXPECT_TRUE(flow.Compute(Both(Moment(3), Moment(3))).value().fields[1].has_value());
}

TEST(ObservationFlowTest, ACameraThatRepeatsItsImageWhileTheOtherOneMovesGivesNoFlow) {
  ObservationFlow flow({});
  const Moment frozen(0);
  ASSERT_THAT(flow.Compute(Both(frozen, Moment(0))), IsOk());
  for (int i = 1; i < 4; ++i) {
    const ObservedFlow seen = flow.Compute(Both(frozen, Moment(i))).value();
    EXPECT_TRUE(seen.makes_step);
    EXPECT_FALSE(seen.fields[0].has_value());
    EXPECT_TRUE(seen.fields[1].has_value());
  }
  const ObservedFlow alive = flow.Compute(Both(Moment(1), Moment(4))).value();
  EXPECT_TRUE(alive.fields[0].has_value());
}

double MedianFlow(const std::optional<FlowField>& field) {
  std::vector<float> lengths;
  for (const FlowVector& v : field->vectors) lengths.push_back(static_cast<float>(v.Length()));
  return double{Median(lengths)};
}

Observation Numbered(std::int64_t sequence, Observation observation) {
  observation.sequence = sequence;
  return observation;
}

TEST(ObservationFlowTest, TheReferenceStaysUntilTheFlowIsMeasurable) {
  ObservationFlow flow({});
  const Moment start(0);
  ASSERT_THAT(flow.Compute(Numbered(0, Both(start, start))), IsOk());
  // 0.06 px an observation: a step takes 0.24 px.
  int steps = 0;
  for (std::int64_t i = 1; i <= 20; ++i) {
    const Moment now(0.04 * static_cast<double>(i));
    const ObservedFlow seen = flow.Compute(Numbered(i, Both(now, now))).value();
    ASSERT_TRUE(seen.fields[0].has_value() && seen.fields[1].has_value());
    if (seen.makes_step) {
      ++steps;
      EXPECT_EQ(flow.reference_sequence(), i);
      EXPECT_NEAR(MedianFlow(seen.fields[0]), 0.27, 0.05);
    }
  }
  EXPECT_GE(steps, 4);
  EXPECT_LE(steps, 5);
}

TEST(ObservationFlowTest, RepeatedFramesMakeNoStepAndChangeNoField) {
  ObservationFlow flow({});
  const Moment first(0);
  const Moment second(1);
  EXPECT_FALSE(flow.Compute(Numbered(0, Both(first, first))).value().makes_step);
  for (std::int64_t i = 1; i < 5; ++i) {
    EXPECT_FALSE(flow.Compute(Numbered(i, Both(first, first))).value().makes_step);
    EXPECT_EQ(flow.reference_sequence(), 0);
  }
  ObservationFlow direct({});
  ASSERT_THAT(direct.Compute(Both(first, first)), IsOk());
  const ObservedFlow expected = direct.Compute(Both(second, second)).value();
  const ObservedFlow seen = flow.Compute(Numbered(5, Both(second, second))).value();
  EXPECT_TRUE(seen.makes_step);
  EXPECT_EQ(seen.fields[0]->vectors, expected.fields[0]->vectors);
  EXPECT_EQ(seen.fields[1]->vectors, expected.fields[1]->vectors);
}

TEST(ObservationFlowTest, ACameraAbsentOnlyWhereNoStepIsMadeLosesNothing) {
  ObservationFlow flow({});
  const Moment first(0);
  ASSERT_THAT(flow.Compute(Both(first, first)), IsOk());
  EXPECT_FALSE(flow.Compute(LeftOnly(first)).value().makes_step);
  const Moment second(1);
  const ObservedFlow back = flow.Compute(Both(second, second)).value();
  EXPECT_TRUE(back.makes_step);
  ASSERT_TRUE(back.fields[1].has_value());
  EXPECT_NEAR(MedianFlow(back.fields[1]), 1.5, 0.1);
}

TEST(ObservationFlowTest, OneCameraThatMovesIsEnoughForBoth) {
  ObservationFlow flow({});
  const Moment first(0);
  const Moment second(1);
  ASSERT_THAT(flow.Compute(Both(first, first)), IsOk());
  EXPECT_TRUE(flow.Compute(Numbered(1, Both(first, second))).value().makes_step);
  EXPECT_EQ(flow.reference_sequence(), 1);
}

// Two scenes with texture at opposite ends: nothing of the first is found again.
TEST(ObservationFlowTest, LostTrackingMakesAStep) {
  ObservationFlow flow({});
  Moment here(0);
  Moment elsewhere(0);
  here.image.colRange(40, 160) = cv::Scalar(120);
  elsewhere.image.colRange(0, 120) = cv::Scalar(120);
  ASSERT_THAT(flow.Compute(LeftOnly(here)), IsOk());
  const ObservedFlow lost = flow.Compute(Numbered(1, LeftOnly(elsewhere))).value();
  ASSERT_LT(lost.fields[0]->vectors.size(), 8U);
  EXPECT_TRUE(lost.makes_step);
  EXPECT_EQ(flow.reference_sequence(), 1);
}

TEST(ObservationFlowTest, DarkFramesMakeNoStepAndTheReferenceMovesOn) {
  ObservationFlow flow({});
  const Moment bright(0);
  Moment dark(0);
  dark.image = cv::Scalar(3);
  ASSERT_THAT(flow.Compute(LeftOnly(bright)), IsOk());
  for (std::int64_t i = 1; i < 4; ++i) {
    EXPECT_FALSE(flow.Compute(Numbered(i, LeftOnly(dark))).value().makes_step);
    EXPECT_EQ(flow.reference_sequence(), i);
  }
  const Moment second(1);
  EXPECT_FALSE(flow.Compute(Numbered(4, LeftOnly(second))).value().makes_step);
  EXPECT_EQ(flow.reference_sequence(), 4);
  EXPECT_TRUE(flow.Compute(Numbered(5, LeftOnly(Moment(2)))).value().makes_step);
}

// The last camera of the reference is lost, and the other goes on alone.
TEST(ObservationFlowTest, TheReferenceMovesOnWhenNoCameraHasOne) {
  ObservationFlow flow({});
  const Moment first(0);
  ASSERT_THAT(flow.Compute(LeftOnly(first)), IsOk());
  for (int i = 1; i < 4; ++i) {
    const Moment now(i);
    Observation right{i, 0, false, {std::monostate(), now.frame()}};
    const ObservedFlow seen = flow.Compute(right).value();
    EXPECT_EQ(seen.makes_step, i > 1);
    EXPECT_EQ(flow.reference_sequence(), i);
  }
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
                                         HasSubstr("left: must be set unless right is")));
}

Observation OfVectors(FlowField field) {
  return {0, 0, false, {std::move(field), std::monostate()}};
}

TEST(ObservationFlowTest, FlowVectorsArePassedOn) {
  ObservationFlow flow({});
  const FlowField field{160, 120, {{1, 2, 3, 4}, {5, 6, 7, 8}}};
  EXPECT_EQ(flow.Compute(OfVectors(field)).value().fields[0]->vectors, field.vectors);
}

TEST(ObservationFlowTest, FlowVectorsMakeAStepByTheirMedianOrIfThereAreFew) {
  ObservationFlow flow({});
  const FlowField still{160, 120, std::vector<FlowVector>(8, {50, 50, 50.1F, 50})};
  EXPECT_FALSE(flow.Compute(OfVectors(still)).value().makes_step);
  const FlowField moving{160, 120, std::vector<FlowVector>(8, {50, 50, 51, 50})};
  EXPECT_TRUE(flow.Compute(OfVectors(moving)).value().makes_step);
  EXPECT_TRUE(flow.Compute(OfVectors({160, 120, {}})).value().makes_step);
  Observation broken = OfVectors(moving);
  broken.break_before = true;
  const ObservedFlow dropped = flow.Compute(broken).value();
  EXPECT_FALSE(dropped.makes_step);
  EXPECT_FALSE(dropped.fields[0].has_value());
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
        BadField{{160, 120, {{1, 2, 3, 4}, {1, kNan, 3, 4}}}, "left.flow_vectors[1]: "},
        BadField{{160, 120, {{1, 2, kInfinite, 4}}}, "flow_vectors[0]: "},
        BadField{{160, 120, {{1, 2, 3, -kInfinite}}}, "flow_vectors[0]: "},
        BadField{{160, 120, {{1, 2, 1e6F, 4}}}, "flow_vectors[0]: "},
        BadField{{0, 120, {}}, "left.flow_vectors.width: 0 must be"},
        BadField{{160, 1 << 30, {}}, "[16, 8192] px"},
        BadField{{160, 120, std::vector<FlowVector>(100001)}, "at most 100000 vectors"}));

}  // namespace
}  // namespace homing
