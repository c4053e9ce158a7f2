#include "nerf/geometry/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace nerf {
namespace {

using Eigen::Vector3d;

Ray MakeRay(const Vector3d& origin, const Vector3d& direction) {
  return {origin, direction.normalized()};
}

void ExpectHit(const Shape& shape, const Ray& ray, double distance, const Vector3d& normal) {
  const auto hit = Intersect(shape, ray);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->distance, distance, 1e-12);
  EXPECT_LT((hit->normal_in_world - normal).norm(), 1e-12) << hit->normal_in_world.transpose();
}

TEST(Sphere, IsHitOnTheNearSideWithAnOutwardNormal) {
  const Sphere sphere{{1, 2, 3}, 0.5};
  ExpectHit(sphere, MakeRay({1, -3, 3}, {0, 1, 0}), 4.5, {0, -1, 0});
  // At 0.3 from the centre, half the chord is 0.4.
  ExpectHit(sphere, MakeRay({1.3, -3, 3}, {0, 1, 0}), 4.6, {0.6, -0.8, 0});
}

TEST(Sphere, IsHitOnTheFarSideFromInsideWithAnOutwardNormal) {
  ExpectHit(Sphere{{1, 2, 3}, 0.5}, MakeRay({1, 2.25, 3}, {0, 1, 0}), 0.25, {0, 1, 0});
}

TEST(Sphere, IsMissedBesideAndBehind) {
  const Sphere sphere{{0, 0, 0}, 1};
  EXPECT_FALSE(Intersect(sphere, MakeRay({-5, 1.0001, 0}, {1, 0, 0})));
  EXPECT_FALSE(Intersect(sphere, MakeRay({5, 0, 0}, {1, 0, 0})));
}

TEST(Sphere, IsHitByGrazingRaysInsideTheTangentOnly) {
  const Sphere sphere{{0, 0, 0}, 1};
  const double inside = 1 - 1e-12;
  const auto hit = Intersect(sphere, MakeRay({-5, inside, 0}, {1, 0, 0}));
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->distance, 5, 1e-5);
  EXPECT_NEAR(hit->normal_in_world.y(), 1, 1e-11);
  EXPECT_FALSE(Intersect(sphere, MakeRay({-5, 1 + 1e-12, 0}, {1, 0, 0})));
}

TEST(Sphere, IsPreciseFromFarAway) {
  // b^2 - 4ac would lose the radius to cancellation.
  const auto hit = Intersect(Sphere{{0, 0, 0}, 1e-3}, MakeRay({-1e6, 0, 0}, {1, 0, 0}));
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->distance, 1e6 - 1e-3, 1e-9);
}

TEST(Sphere, IgnoresHitsBeforeTheMinimumDistance) {
  const Ray ray = MakeRay({-3, 0, 0}, {1, 0, 0});
  const Sphere sphere{{0, 0, 0}, 1};
  EXPECT_NEAR(Intersect(sphere, ray, 2.5)->distance, 4, 1e-12);
  EXPECT_FALSE(Intersect(sphere, ray, 4.5));
}

TEST(Box, IsHitOnTheFaceTowardsTheRay) {
  const Box box{{0, 0, 1}, {1, 2, 0.5}};
  ExpectHit(box, MakeRay({-4, 0.5, 1}, {1, 0, 0}), 3, {-1, 0, 0});
  ExpectHit(box, MakeRay({4, 0.5, 1}, {-1, 0, 0}), 3, {1, 0, 0});
  ExpectHit(box, MakeRay({0.5, 1, 4}, {0, 0, -1}), 2.5, {0, 0, 1});
  ExpectHit(box, MakeRay({0.5, 5, 1.2}, {0, -1, 0}), 3, {0, 1, 0});
}

TEST(Box, IsHitOnTheFaceAheadFromInside) {
  const Box box{{0, 0, 1}, {1, 2, 0.5}};
  ExpectHit(box, MakeRay({0.25, 0, 1}, {1, 0, 0}), 0.75, {1, 0, 0});
  ExpectHit(box, MakeRay({0, 0, 1}, {0, 0, -1}), 0.5, {0, 0, -1});
}

TEST(Box, RotatesWithItsHeading) {
  // Rotated by 45 degrees, a unit cube has an edge at sqrt(2)/2 and diagonal normals.
  const Box box{{0, 0, 0}, {0.5, 0.5, 0.5}, HeadingFromDegrees(45)};
  const double half = std::numbers::sqrt2 / 2;
  ExpectHit(box, MakeRay({5, 0.1, 0}, {-1, 0, 0}), 5 - (half - 0.1), {half, half, 0});
  ExpectHit(box, MakeRay({5, -0.1, 0}, {-1, 0, 0}), 5 - (half - 0.1), {half, -half, 0});
  EXPECT_FALSE(Intersect(box, MakeRay({5, half + 1e-6, 0}, {-1, 0, 0})));
}

TEST(Box, IsMissedByParallelRaysOutsideASlab) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  EXPECT_FALSE(Intersect(box, MakeRay({-5, 1.5, 0}, {1, 0, 0})));
  EXPECT_FALSE(Intersect(box, MakeRay({5, 0, 0}, {1, 0, 0})));
  EXPECT_FALSE(Intersect(box, MakeRay({-5, 0, 0}, {1, 0.5, 0})));
}

TEST(Box, SignedZerosInADirectionMakeNoDifference) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  for (const double zero : {0.0, -0.0}) {
    ExpectHit(box, MakeRay({-5, 0.5, 0.5}, {1, zero, zero}), 4, {-1, 0, 0});
    EXPECT_FALSE(Intersect(box, MakeRay({-5, 1.5, 0}, {1, zero, zero})));
  }
}

// Rays from a face, along a face, along an edge, and through a corner.
TEST(Box, HitsOfTouchingRaysAreOnTheSurface) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const Eigen::Vector3d& along :
           {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-0.0, -0.0, -1),
            Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(-1, 1, 1)}) {
        for (const double back : {0.0, 3.0}) {
          const Eigen::Vector3d d = along.normalized();
          const auto hit = Intersect(box, {Eigen::Vector3d(x, y, 0) - back * d, d});
          if (!hit) continue;
          EXPECT_TRUE(std::isfinite(hit->distance) && hit->distance >= 0);
          EXPECT_NEAR(hit->normal_in_world.norm(), 1, 1e-12);
          const Eigen::Vector3d at = Eigen::Vector3d(x, y, 0) + (hit->distance - back) * d;
          EXPECT_NEAR(at.cwiseAbs().maxCoeff(), 1, 1e-12) << "on the surface";
        }
      }
    }
  }
}

TEST(Disc, IsHitWithinItsRadiusFromBothSides) {
  const Disc disc{{1, 0, 0.5}, 2};
  ExpectHit(disc, MakeRay({1, 0, 2.5}, {0, 0, -1}), 2, {0, 0, 1});
  ExpectHit(disc, MakeRay({1, 1.9, -1}, {0, 0, 1}), 1.5, {0, 0, 1});
  EXPECT_FALSE(Intersect(disc, MakeRay({1, 2.1, 2}, {0, 0, -1})));
}

TEST(Disc, IsMissedByParallelAndDepartingRays) {
  const Disc disc{{0, 0, 0}, 2};
  EXPECT_FALSE(Intersect(disc, MakeRay({-5, 0, 0}, {1, 0, 0})));
  EXPECT_FALSE(Intersect(disc, MakeRay({0, 0, 1}, {0, 0, 1})));
}

TEST(ShapeFromWorld, IsRelativeToTheCenterAndTheAxes) {
  const Box box{{1, 2, 3}, {1, 1, 1}, HeadingFromDegrees(90)};
  // The x axis of the box is the world y axis.
  EXPECT_LT((ShapeFromWorld(box, {1, 2.5, 3.25}) - Vector3d(0.5, 0, 0.25)).norm(), 1e-12);
  EXPECT_LT((ShapeFromWorld(Sphere{{1, 2, 3}, 1}, {1, 2.5, 3}) - Vector3d(0, 0.5, 0)).norm(),
            1e-12);
}

}  // namespace
}  // namespace nerf
