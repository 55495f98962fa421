#include "homing/flow/vertical_turn.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

namespace homing {
namespace {

constexpr double kFocal = 300;

// Both cameras turn by `turn` rad to the left, while driving moves everything sideways by `driven`
// pixels, each row as near as its own things.
ObservedFlow TurningFlow(double turn, double driven) {
  ObservedFlow flow;
  for (std::size_t side = 0; side < 2; ++side) {
    FlowField field{.width = 320, .height = 240, .vectors = {}};
    for (int i = 0; i < 120; ++i) {
      const double x = 15 + 24.0 * (i % 12);
      const double y = 15 + 20.0 * (i / 12);
      const double right = (x - 159.5) / kFocal;
      const double down = (y - 119.5) / kFocal;
      const double moved_x = kFocal * turn * (1 + right * right) +
                             (side == 0 ? -driven : driven) * (0.6 + 0.1 * (i % 7));
      const double moved_y = kFocal * turn * right * down;
      field.vectors.push_back(
          {static_cast<float>(x - moved_x / 2), static_cast<float>(y - moved_y / 2),
           static_cast<float>(x + moved_x / 2), static_cast<float>(y + moved_y / 2)});
    }
    flow.fields[side] = std::move(field);
  }
  return flow;
}

std::array<Camera, 2> Calibrated() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.intrinsics = Intrinsics{kFocal, kFocal, 159.5, 119.5};
  return {camera, camera};
}

// The plain reference: one vector after the other.
VerticalTurn PlainTurn(const FlowField& field) {
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  double noise = 1 / kFocal, variance = 0;
  for (int pass = 0; pass < 3; ++pass) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0, used = 0;
    for (const FlowVector& v : field.vectors) {
      const double x = (v.MidX() - 159.5) / kFocal, y = (v.MidY() - 119.5) / kFocal;
      const Eigen::Vector3d row(x * y, 1 + y * y, -x);
      const double flow = v.FlowY() / kFocal;
      const double error = flow - row.dot(fit);
      if (!(std::abs(error) < 3 * noise)) continue;
      normal += row * row.transpose();
      right += row * flow;
      squares += error * error;
      used += 1;
    }
    fit = normal.ldlt().solve(right);
    if (pass > 0) noise = std::max(0.1 / kFocal, std::sqrt(squares / used));
    variance = noise * noise * normal.inverse()(0, 0);
  }
  return {fit[0], variance};
}

TEST(VerticalTurnTest, IsWhatThePlainReferenceGives) {
  std::mt19937_64 engine(11);
  std::normal_distribution<float> noise(0, 0.3F);
  for (std::size_t size = 60; size < 120; ++size) {
    FlowField field = *TurningFlow(0.02, 5).fields[0];
    field.vectors.resize(size);
    for (FlowVector& v : field.vectors) v.end_y += noise(engine);
    // Some that no turn explains.
    for (std::size_t i = 0; i < size; i += 9) field.vectors[i].end_y += 30;
    const VerticalTurn expected = PlainTurn(field);
    const VerticalTurn read = ReadVerticalTurn(field, Calibrated()[0]);
    EXPECT_NEAR(read.turn, expected.turn, 1e-9) << size;
    EXPECT_NEAR(read.variance, expected.variance, 1e-9) << size;
  }
}

TEST(VerticalTurnTest, IsPositiveToTheLeft) {
  for (const double turn : {-0.05, -0.01, 0.0, 0.01, 0.05}) {
    const VerticalTurn read = ReadVerticalTurn(TurningFlow(turn, 5), Calibrated());
    EXPECT_NEAR(read.turn, turn, 0.003);
    EXPECT_LT(read.variance, 0.01);
  }
}

TEST(VerticalTurnTest, DrivingAheadIsNoTurn) {
  for (const double driven : {1.0, 5.0, 20.0}) {
    EXPECT_NEAR(ReadVerticalTurn(TurningFlow(0, driven), Calibrated()).turn, 0, 1e-6) << driven;
  }
}

TEST(VerticalTurnTest, FewVectorsTellNothing) {
  ObservedFlow flow = TurningFlow(0.05, 5);
  flow.fields[0]->vectors.resize(3);
  flow.fields[1]->vectors.resize(3);
  EXPECT_NEAR(ReadVerticalTurn(flow, Calibrated()).variance, 0.5, 1e-9);
}

TEST(VerticalTurnTest, OneCameraIsEnough) {
  const ObservedFlow both = TurningFlow(0.05, 5);
  ObservedFlow one = both;
  one.fields[0].reset();
  EXPECT_NEAR(ReadVerticalTurn(one, Calibrated()).turn, ReadVerticalTurn(both, Calibrated()).turn,
              0.005);
  one.fields[1].reset();
  EXPECT_EQ(ReadVerticalTurn(one, Calibrated()).variance, 1);
}

}  // namespace
}  // namespace homing
