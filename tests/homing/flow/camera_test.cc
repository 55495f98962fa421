#include "homing/flow/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "homing/flow/undistortion.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Camera IdealCamera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.intrinsics = Intrinsics{277, 277, 160, 120};
  return camera;
}

FlowField FieldOf(std::vector<FlowVector> vectors) { return {320, 240, std::move(vectors)}; }

TEST(RectifyTest, WithoutIntrinsicsTheVectorsStay) {
  const FlowField raw = FieldOf({{1, 2, 3, 4}, {319.4F, 0, -0.4F, 239}});
  EXPECT_EQ(Rectify(raw, {}).vectors, raw.vectors);
  EXPECT_EQ(Rectify(raw, IdealCamera()).vectors, raw.vectors);
}

TEST(RectifyTest, NonFiniteVectorsAreDropped) {
  const float nan = std::nanf("");
  const float infinite = std::numeric_limits<float>::infinity();
  const FlowField raw = FieldOf({{nan, 2, 3, 4}, {1, 2, 3, infinite}, {1, 2, 3, 4}});
  EXPECT_EQ(Rectify(raw, {}).vectors.size(), 1U);
  Camera camera = IdealCamera();
  camera.yaw_rad = 0.01;
  EXPECT_EQ(Rectify(raw, camera).vectors.size(), 0U + 1U);
}

// A camera turned clockwise by 0.1 rad shows what lies ahead of it; the ideal camera sees that
// 277 tan(0.1) = 27.793 px right of its centre.
TEST(RectifyTest, YawTurnsTheRay) {
  Camera camera = IdealCamera();
  camera.yaw_rad = 0.1;
  const FlowField ideal = Rectify(FieldOf({{160, 120, 160, 150}}), camera);
  ASSERT_EQ(ideal.vectors.size(), 1U);
  EXPECT_NEAR(ideal.vectors[0].start_x, 187.793, 1e-3);
  EXPECT_NEAR(ideal.vectors[0].start_y, 120, 1e-4);
  EXPECT_NEAR(ideal.vectors[0].end_x, 187.793, 1e-3);
  // 30 / cos(0.1) = 30.151 below the centre.
  EXPECT_NEAR(ideal.vectors[0].end_y, 150.151, 1e-3);
}

TEST(RectifyTest, WhatTheIdealCameraCannotSeeIsDropped) {
  Camera camera = IdealCamera();
  camera.yaw_rad = 1.4;
  EXPECT_THAT(Rectify(FieldOf({{160, 120, 161, 120}, {300, 120, 301, 120}}), camera).vectors,
              IsEmpty());
}

TEST(RectifyTest, DistortionIsUndone) {
  Camera camera = IdealCamera();
  camera.distortion = {-0.3, 0.08, 0.001, -0.002, 0.01};
  const Eigen::Vector2d ray(0.3, -0.25);
  const Eigen::Vector2d shown = 277 * Distort(ray, camera.distortion);
  const auto x = static_cast<float>(160 + shown.x());
  const auto y = static_cast<float>(120 + shown.y());
  const FlowField ideal = Rectify(FieldOf({{x, y, x, y}}), camera);
  ASSERT_EQ(ideal.vectors.size(), 1U);
  EXPECT_NEAR(ideal.vectors[0].start_x, 160 + 277 * 0.3, 1e-3);
  EXPECT_NEAR(ideal.vectors[0].start_y, 120 - 277 * 0.25, 1e-3);
}

// k1 = 0.1 at (0.5, 0): 0.5 (1 + 0.1 * 0.25) = 0.5125. p1 = 0.01 at (0.5, 0.2):
// x + 2 p1 x y = 0.502, y + p1 (r2 + 2 y2) = 0.2 + 0.01 * 0.37 = 0.2037.
TEST(DistortTest, AgreesWithHandComputedValues) {
  EXPECT_NEAR(Distort({0.5, 0}, {0.1, 0, 0, 0, 0}).x(), 0.5125, 1e-15);
  const Eigen::Vector2d tangential = Distort({0.5, 0.2}, {0, 0, 0.01, 0, 0});
  EXPECT_NEAR(tangential.x(), 0.502, 1e-15);
  EXPECT_NEAR(tangential.y(), 0.2037, 1e-15);
}

TEST(UndistortTest, IsTheInverseOverTheImage) {
  const Distortion lens{-0.35, 0.12, 0.0015, -0.001, -0.02};
  for (double x = -0.7; x <= 0.7; x += 0.1) {
    for (double y = -0.5; y <= 0.5; y += 0.1) {
      const auto ray = Undistort(Distort({x, y}, lens), lens);
      ASSERT_TRUE(ray.has_value());
      EXPECT_NEAR((*ray - Eigen::Vector2d(x, y)).norm(), 0, 1e-10);
    }
  }
}

// Each of the eight parameters by itself, at (0.5, 0.2): r2 = 0.29, r4 = 0.0841, r6 = 0.024389.
TEST(DistortTest, EachParameterAgreesWithAHandComputedValue) {
  const std::array<Eigen::Vector2d, 8> expected = {{{0.5 * 1.029, 0.2 * 1.029},
                                                    {0.5 * 1.00841, 0.2 * 1.00841},
                                                    {0.5 + 0.02, 0.2 + 0.037},
                                                    {0.5 + 0.079, 0.2 + 0.02},
                                                    {0.5 * 1.0024389, 0.2 * 1.0024389},
                                                    {0.5 / 1.029, 0.2 / 1.029},
                                                    {0.5 / 1.00841, 0.2 / 1.00841},
                                                    {0.5 / 1.0024389, 0.2 / 1.0024389}}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    Distortion lens{};
    lens[i] = 0.1;
    const Eigen::Vector2d shown = Distort({0.5, 0.2}, lens);
    EXPECT_NEAR((shown - expected[i]).norm(), 0, 1e-15) << i;
  }
}

// A fisheye at 45 degrees: a = 0.7853982, a^3 = 0.4844730, a^5 = 0.2988474, a^7 = 0.1843441,
// a^9 = 0.1137127.
TEST(DistortTest, EachParameterOfAFisheyeAgreesWithAHandComputedValue) {
  const std::array<double, 4> powers = {0.4844730, 0.2988474, 0.1843441, 0.1137127};
  for (std::size_t i = 0; i < powers.size(); ++i) {
    Distortion lens{};
    lens[i] = 0.1;
    EXPECT_NEAR(DistortFisheye({1, 0}, lens).x(), 0.7853982 + 0.1 * powers[i], 1e-7) << i;
  }
}

// At r2 = 0.25 the factor is (1 + 0.1 * 0.25) / (1 + 0.2 * 0.25 + 0.4 * 0.0625) = 1.025 / 1.075.
TEST(UndistortTest, TheRadialPartMayHaveADivisor) {
  const Distortion lens{0.1, 0, 0, 0, 0, 0.2, 0.4, 0};
  EXPECT_NEAR(Distort({0.5, 0}, lens).x(), 0.5 * 1.025 / 1.075, 1e-15);
  const Distortion real{0.35, -0.12, 0.0015, -0.001, 0.02, 0.7, -0.05, 0.03};
  for (double x = -0.9; x <= 0.9; x += 0.3) {
    const auto ray = Undistort(Distort({x, 0.4}, real), real);
    ASSERT_TRUE(ray.has_value()) << x;
    EXPECT_NEAR((*ray - Eigen::Vector2d(x, 0.4)).norm(), 0, 1e-9) << x;
  }
}

// A ray at 45 degrees: a = pi/4, a (1 + 0.1 a^2) = 0.785398 + 0.0484473.
TEST(UndistortTest, AFisheyeFollowsTheAngle) {
  EXPECT_NEAR(DistortFisheye({1, 0}, {0.1}).x(), 0.8338455, 1e-7);
  EXPECT_NEAR(DistortFisheye({0.6, -0.8}, {0.1}).y(), -0.8 * 0.8338455, 1e-7);
  EXPECT_EQ(DistortFisheye({0, 0}, {0.1}), Eigen::Vector2d(0, 0));
  const Distortion lens{-0.02, 0.005, -0.003, 0.0004};
  for (double x = -5; x <= 5; x += 0.5) {
    const auto ray = UndistortFisheye(DistortFisheye({x, 0.3}, lens), lens);
    ASSERT_TRUE(ray.has_value()) << x;
    EXPECT_NEAR((*ray - Eigen::Vector2d(x, 0.3)).norm(), 0, 1e-8) << x;
  }
  // From the side and from behind.
  EXPECT_FALSE(UndistortFisheye({1.6, 0}, {}).has_value());
  EXPECT_FALSE(UndistortFisheye({9, 0}, {-0.5}).has_value());
}

// Without coefficients the angle itself: 277 tan(0.1) = 27.793 px.
TEST(RectifyTest, AFisheyeIsUndone) {
  Camera camera = IdealCamera();
  camera.fisheye = true;
  const FlowField ideal = Rectify(FieldOf({{187.7F, 120, 160, 120}}), camera);
  ASSERT_EQ(ideal.vectors.size(), 1U);
  EXPECT_NEAR(ideal.vectors[0].start_x, 187.793, 1e-3);
  EXPECT_NEAR(ideal.vectors[0].end_x, 160, 1e-4);
}

TEST(UndistortTest, BeyondTheFoldThereIsNoRay) {
  // r (1 - 0.5 r^2) is at most 0.544.
  EXPECT_FALSE(Undistort({0.6, 0}, {-0.5, 0, 0, 0, 0}).has_value());
}

struct BadCamera {
  std::string field;
  void (*spoil)(Camera&);
};

class BadCameraTest : public ::testing::TestWithParam<BadCamera> {};

TEST_P(BadCameraTest, IsNamed) {
  Camera camera = IdealCamera();
  ASSERT_THAT(Validate(camera), IsOk());
  GetParam().spoil(camera);
  EXPECT_THAT(Validate(camera), StatusIs(absl::StatusCode::kInvalidArgument,
                                         ::testing::StartsWith(GetParam().field + ": ")));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCameraTest,
    ::testing::Values(BadCamera{"width", [](Camera& c) { c.width = -1; }},
                      BadCamera{"height", [](Camera& c) { c.height = 1 << 20; }},
                      BadCamera{"width", [](Camera& c) { c.width = 0; }},
                      BadCamera{"focal_x", [](Camera& c) { c.intrinsics->focal_x = 0; }},
                      BadCamera{"focal_y", [](Camera& c) { c.intrinsics->focal_y = std::nan(""); }},
                      BadCamera{"center_x", [](Camera& c) { c.intrinsics->center_x = 1e300; }},
                      BadCamera{"distortion", [](Camera& c) { c.distortion[4] = std::nan(""); }},
                      BadCamera{"yaw_rad", [](Camera& c) { c.yaw_rad = 1.5708; }},
                      BadCamera{"focal_x",
                                [](Camera& c) {
                                  c.intrinsics.reset();
                                  c.yaw_rad = 0.1;
                                }}),
    [](const auto& bad) { return "Camera" + std::to_string(bad.index); });

}  // namespace
}  // namespace homing
