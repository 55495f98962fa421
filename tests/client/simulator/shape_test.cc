#include "client/simulator/shape.h"

#include <gtest/gtest.h>

#include <numbers>

namespace homing::client {
namespace {

// At the origin, 1 m up, heading along x, looking left along y.
CameraPose LeftCamera() { return LookAside({{0, 0}, 0}, 1, Side::kLeft); }

TEST(ShapeTest, ACameraToTheLeftHasItsXAxisAlongTheRoute) {
  const Vector3 seen = LeftCamera().FromWorld({2, 10, 4});
  EXPECT_EQ(seen, Vector3(2, -3, 10));
}

TEST(ShapeTest, ACameraToTheRightHasItsXAxisAgainstTheRoute) {
  const Vector3 seen = LookAside({{0, 0}, 0}, 1, Side::kRight).FromWorld({2, -10, 4});
  EXPECT_EQ(seen, Vector3(-2, -3, 10));
}

TEST(ShapeTest, AParallelogramIsMetInsideItsEdgesOnly) {
  const ViewedParallelogram wall({{-1, 5, 0}, {2, 0, 0}, {0, 0, 3}}, LeftCamera());
  EXPECT_NEAR(wall.Depth({0, 0}), 5, 1e-12);
  EXPECT_EQ(wall.Depth({0.21, 0}), kNothing);
  EXPECT_EQ(wall.Depth({0, -0.41}), kNothing);
  const Vector2 place = wall.Texture({0.1, 0}, 5);
  EXPECT_NEAR(place[0], 1.5, 1e-12);
  EXPECT_NEAR(place[1], 1.0, 1e-12);
}

TEST(ShapeTest, ASlantedParallelogramIsMetAlongItsSlant) {
  const ViewedParallelogram board({{-1, 5, 0}, {2, 0, 0}, {1, 0, 2}}, LeftCamera());
  EXPECT_NEAR(board.Depth({0.2, -0.1}), 5, 1e-12);
  EXPECT_EQ(board.Depth({-0.15, -0.1}), kNothing);
}

TEST(ShapeTest, ACylinderIsMetAtItsNearSide) {
  const ViewedCylinder tower({{0, 8}, 1, 0, 3}, LeftCamera());
  EXPECT_NEAR(tower.Depth({0, 0}), 7, 1e-12);
  EXPECT_EQ(tower.Depth({0.13, 0}), kNothing);
  EXPECT_EQ(tower.Depth({0, -0.3}), kNothing);
  EXPECT_NEAR(tower.Texture({0, 0}, 7)[0], -std::numbers::pi / 2, 1e-12);
}

TEST(ShapeTest, ASphereIsMetAtItsNearSideAndMissedBesideIt) {
  const ViewedEllipsoid sphere({{0, 8, 1}, {2, 2, 2}, 0}, LeftCamera());
  EXPECT_NEAR(sphere.Depth({0, 0}), 6, 1e-12);
  // The silhouette is at tan(asin(2 / 8)).
  const double edge = 2 / std::sqrt(60.0);
  EXPECT_LT(sphere.Depth({edge - 1e-6, 0}), 8);
  EXPECT_EQ(sphere.Depth({edge + 1e-6, 0}), kNothing);
}

TEST(ShapeTest, AnEllipsoidIsTurnedByItsHeading) {
  const ViewedEllipsoid hill({{0, 8, 1}, {3, 1, 2}, std::numbers::pi / 2}, LeftCamera());
  EXPECT_NEAR(hill.Depth({0, 0}), 5, 1e-12);
}

TEST(ShapeTest, WhatIsBehindTheCameraHasNoBounds) {
  const ViewedEllipsoid sphere({{0, -8, 1}, {2, 2, 2}, 0}, LeftCamera());
  EXPECT_GT(sphere.Bounds().low.x, sphere.Bounds().high.x);
  const ViewedParallelogram wall({{-1, -5, 0}, {2, 0, 0}, {0, 0, 3}}, LeftCamera());
  EXPECT_GT(wall.Bounds().low.x, wall.Bounds().high.x);
}

TEST(ShapeTest, BoundsHoldEveryRayThatMeetsTheShape) {
  const CameraPose camera = LookAside({{0.3, -0.2}, 0.1}, 1, Side::kLeft);
  const std::vector<Shape> shapes = {Parallelogram{{-1, 4, 0}, {2, 1, 0}, {0.5, 0.2, 2}},
                                     Parallelogram{{1, -3, 0}, {1, 9, 0}, {0, 0, 2}},
                                     Cylinder{{1, 4}, 0.8, 0, 3},
                                     Ellipsoid{{-1, 6, 0}, {1, 2, 1.5}, 0.7}};
  for (const Shape& shape : shapes) {
    std::visit(
        [](const auto& seen) {
          const RayBounds bounds = seen.Bounds();
          int hits = 0;
          for (double y = -1; y <= 1; y += 0.01) {
            for (double x = -1; x <= 1; x += 0.01) {
              const double depth = seen.Depth({x, y});
              if (depth <= kNearest || depth == kNothing) {
                continue;
              }
              ++hits;
              EXPECT_TRUE(x >= bounds.low.x - 1e-9 && x <= bounds.high.x + 1e-9) << x;
              EXPECT_TRUE(y >= bounds.low.y - 1e-9 && y <= bounds.high.y + 1e-9) << y;
            }
          }
          EXPECT_GT(hits, 20);
        },
        Seen(shape, camera));
  }
}

}  // namespace
}  // namespace homing::client
