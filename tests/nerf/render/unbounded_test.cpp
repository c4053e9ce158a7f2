#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/sampling/ray_intervals.h"
#include "nerf/sampling/ray_marcher.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

RayBatch OneRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
  RayBatch ray;
  ray.Resize(1);
  std::copy_n(origin.data(), 3, ray.origin.begin());
  std::copy_n(direction.normalized().eval().data(), 3, ray.direction.begin());
  ray.jitter = {0.5f};
  return ray;
}

MarchOptions Bounded() {
  MarchOptions march;
  march.unbounded = false;
  return march;
}

TEST(Bounded, RaysAreClippedToTheUnitBall) {
  const auto range = [](const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    return RangeOfRay(OneRay(origin, direction), 0, Bounded());
  };
  const auto through = range({-3, 0, 0}, {1, 0, 0});
  EXPECT_FLOAT_EQ(through.near, 2);
  EXPECT_FLOAT_EQ(through.far, 4);
  const auto inside = range({0, 0, 0}, {0, 1, 0});
  EXPECT_FLOAT_EQ(inside.near, 0.05f);
  EXPECT_FLOAT_EQ(inside.far, 1);
  const auto off_centre = range({-3, 0.6f, 0}, {1, 0, 0});
  EXPECT_NEAR(off_centre.far - off_centre.near, 1.6, 1e-6);
  for (const auto& missed : {range({-3, 1.1f, 0}, {1, 0, 0}), range({3, 0, 0}, {1, 0, 0})}) {
    EXPECT_EQ(missed.near, missed.far);
  }
  const auto far_off = range({-90, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(far_off.far - far_off.near, 2, 1e-4);
}

TEST(Bounded, NothingIsSampledOutside) {
  test::TwoEngines e;
  e.march = Bounded();
  e.Make(50);
  const PackedSamples samples = MarchRays(e.batch.rays, *e.grid, e.march);
  EXPECT_GT(samples.Size(), 500);
  for (std::size_t i = 0; i < samples.position.size(); i += 3) {
    const Eigen::Vector3f x = 4 * (Eigen::Vector3f(&samples.position[i]).array() - 0.5f);
    EXPECT_LE(x.norm(), 1.0001f);
  }
  std::vector<float> edges(9);
  const RayBatch ray = OneRay({-3, 0.2f, 0}, {1, 0, 0});
  EqualIntervals(ray, 0, e.march, edges);
  const auto [near, far] = RangeOfRay(ray, 0, e.march);
  // Inside the ball nothing is contracted: equal lengths, except at the ends, which jitter moves.
  for (int i = 1; i < 7; ++i) EXPECT_NEAR(edges[i + 1] - edges[i], (far - near) / 8, 3e-3);
  EXPECT_EQ(edges.front(), near);
  EXPECT_EQ(edges.back(), far);
}

TEST(Bounded, IsTheSameInBothEngines) {
  for (const bool with_proposal : {false, true}) {
    test::TwoEngines e;
    e.march = Bounded();
    e.march.steps_per_unit = 24;
    e.Make(50, with_proposal);
    // Some rays miss the ball, on each side of it, from far away.
    for (int r = 0; r < 50; r += 7)
      e.batch.rays.origin[3 * r + r % 3] += r % 2 == 0 ? 3.0f : -30.0f;
    e.ExpectTheSame();
  }
}

TEST(Bounded, ChangesNothingWhereRaysEndInsideTheBall) {
  test::TwoEngines unbounded, bounded;
  unbounded.march.far_distance = bounded.march.far_distance = 0.5;
  bounded.march.unbounded = false;
  unbounded.Make(50);
  bounded.Make(50);
  for (float& x : unbounded.batch.rays.origin) x *= 0.2f;
  for (float& x : bounded.batch.rays.origin) x *= 0.2f;
  EXPECT_EQ(unbounded.fused->Render(unbounded.batch.rays).rgb,
            bounded.fused->Render(bounded.batch.rays).rgb);
}

TEST(Bounded, FollowsTheEffect) {
  EXPECT_TRUE(LoadConfig("base", {}).march.unbounded);
  EXPECT_FALSE(LoadConfig("base", {"effects.unbounded=null"}).march.unbounded);
  EXPECT_FALSE(ConfigFromJson(JsonFromConfig(LoadConfig("base", {"effects.unbounded=null"})), "x")
                   .march.unbounded);
}

}  // namespace
}  // namespace nerf
