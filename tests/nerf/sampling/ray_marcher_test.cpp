#include "nerf/sampling/ray_marcher.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <numeric>

#include "nerf/base/parallel.h"
#include "nerf/base/random.h"
#include "nerf/sampling/contraction.h"

namespace nerf {
namespace {

OccupancyOptions CoarseGrid() {
  OccupancyOptions options;
  options.resolution = 32;
  return options;
}

RayBatch RandomRays(int count) {
  RayBatch rays;
  rays.Resize(count);
  for (int r = 0; r < count; ++r) {
    Eigen::Vector3f d;
    for (int c = 0; c < 3; ++c) {
      rays.origin[3 * r + c] = 3 * RandomFloat(1, 0, 3 * r + c) - 1.5f;
      d[c] = RandomFloat(1, 1, 3 * r + c) - 0.5f;
    }
    Eigen::Map<Eigen::Vector3f>(&rays.direction[3 * r]) = d.normalized();
    rays.jitter[r] = RandomFloat(1, 2, r);
  }
  return rays;
}

TEST(MarchRays, IntervalsOfAFullGridTileTheRayFromNearToFar) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const RayBatch rays = RandomRays(20);
  const PackedSamples samples = MarchRays(rays, grid, options);
  ASSERT_EQ(samples.Rays(), 20);
  for (std::int64_t r = 0; r < 20; ++r) {
    double end = options.near_distance;
    for (std::int64_t i = samples.ray_begin[r]; i < samples.ray_begin[r + 1]; ++i) {
      EXPECT_EQ(samples.ray[i], r);
      EXPECT_NEAR(samples.t[i] - 0.5f * samples.dt[i], end, 1e-4 * (1 + end));
      end = samples.t[i] + 0.5f * samples.dt[i];
      EXPECT_LE(end, options.far_distance * (1 + 1e-5));
    }
    EXPECT_NEAR(end, options.far_distance, 1e-3 * options.far_distance);
  }
}

TEST(MarchRays, SamplesAreOnTheirRayInContractedSpace) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const RayBatch rays = RandomRays(5);
  const PackedSamples samples = MarchRays(rays, grid, options);
  for (std::int64_t i = 0; i < samples.Size(); ++i) {
    const std::int64_t r = samples.ray[i];
    const Eigen::Vector3f x =
        Eigen::Map<const Eigen::Vector3f>(&rays.origin[3 * r]) +
        samples.t[i] * Eigen::Map<const Eigen::Vector3f>(&rays.direction[3 * r]);
    const Eigen::Vector3f expected = UnitCubeFromContracted(Contract(x));
    EXPECT_LT((Eigen::Map<const Eigen::Vector3f>(&samples.position[3 * i]) - expected).norm(),
              1e-5f);
  }
}

TEST(MarchRays, EmptyCellsAreSkipped) {
  const MarchOptions options;
  OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const auto inside = [](const Eigen::Vector3f& x) { return (x.array() > 0.5f).all(); };
  grid.KeepVisible([&](const Eigen::Vector3f& centre, float) { return inside(centre); });
  const PackedSamples samples = MarchRays(RandomRays(50), grid, options);
  EXPECT_GT(samples.Size(), 0);
  for (std::int64_t i = 0; i < samples.Size(); ++i) {
    EXPECT_TRUE(inside(Eigen::Map<const Eigen::Vector3f>(&samples.position[3 * i])));
  }
}

// Space occupied for more than a step on both sides of a point contains the centre of a step.
TEST(MarchRays, OccupiedCellsAreNeverSkipped) {
  MarchOptions options;
  OccupancyGrid grid({.resolution = 64}, options.StepLength());
  grid.KeepVisible([](const Eigen::Vector3f& centre, float) {
    const Eigen::Array3i cell = (centre.array() * 9).cast<int>();
    return RandomFloat(7, cell[0], 100 * cell[1] + cell[2]) < 0.1f;
  });
  const RayBatch rays = RandomRays(200);
  const PackedSamples samples = MarchRays(rays, grid, options);
  int checked = 0;
  for (std::int64_t r = 0; r < rays.Size(); ++r) {
    const Eigen::Vector3f origin(&rays.origin[3 * r]), direction(&rays.direction[3 * r]);
    const auto occupied = [&](float t) {
      return grid.Occupied(UnitCubeFromContracted(Contract(origin + t * direction)));
    };
    for (float t = 0.1f; t < 20.0f; t *= 1.01f) {
      const float dt =
          1.1f * options.StepLength() / ContractedSpeed(origin + t * direction, direction);
      bool solid = true;
      for (int k = -8; k <= 8; ++k) solid = solid && occupied(t + dt * static_cast<float>(k) / 8);
      if (!solid) continue;
      ++checked;
      bool covered = false;
      for (std::int64_t i = samples.ray_begin[r]; i < samples.ray_begin[r + 1]; ++i) {
        covered = covered || std::fabs(samples.t[i] - t) <= 0.51f * samples.dt[i];
      }
      EXPECT_TRUE(covered) << "ray " << r << ", t = " << t;
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(MarchRays, JitterShortensTheFirstStep) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  RayBatch rays = RandomRays(1);
  std::fill(rays.origin.begin(), rays.origin.end(), 0.0f);
  rays.jitter[0] = 0.75f;
  const PackedSamples samples = MarchRays(rays, grid, options);
  EXPECT_NEAR(samples.dt[0], 0.25f * options.StepLength(), 1e-6f);
  EXPECT_NEAR(samples.dt[1], options.StepLength(), 1e-6f);
}

TEST(MarchRays, TheNumberOfThreadsChangesNothing) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const RayBatch rays = RandomRays(300);
  SetNumThreads(1);
  const PackedSamples one = MarchRays(rays, grid, options);
  SetNumThreads(3);
  const PackedSamples three = MarchRays(rays, grid, options);
  SetNumThreads(AvailableCores());
  EXPECT_EQ(one.ray_begin, three.ray_begin);
  EXPECT_EQ(one.position, three.position);
  EXPECT_EQ(one.t, three.t);
}

TEST(MarchRays, ABatchWithoutRaysIsEmpty) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const PackedSamples samples = MarchRays(RandomRays(0), grid, options);
  EXPECT_EQ(samples.Rays(), 0);
  EXPECT_EQ(samples.Size(), 0);
}

TEST(KeepFront, KeepsTheFirstSamplesOfEachRay) {
  const MarchOptions options;
  const OccupancyGrid grid(CoarseGrid(), options.StepLength());
  const PackedSamples all = MarchRays(RandomRays(3), grid, options);
  const PackedSamples front = KeepFront(all, {2, 0, 5});
  EXPECT_EQ(front.ray_begin, (std::vector<std::int64_t>{0, 2, 2, 7}));
  EXPECT_EQ(front.t[1], all.t[1]);
  EXPECT_EQ(front.t[2], all.t[all.ray_begin[2]]);
  EXPECT_EQ(front.ray[6], 2);
}

}  // namespace
}  // namespace nerf
