#include "nerf/effects/anti_aliasing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/render/packet_renderer.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/pixel_sampler.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

// Rays whose footprints are as wide as the cells of the coarser levels.
test::TwoEngines WithFootprint(const std::optional<AntiAliasingOptions>& footprint,
                               bool with_proposal = false) {
  test::TwoEngines e;
  e.anti_aliasing = footprint;
  e.Make(50, with_proposal);
  for (int r = 0; r < 50; ++r) e.batch.rays.spread.push_back(0.02f * static_cast<float>(r % 5));
  return e;
}

RayBatch OneRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float spread) {
  RayBatch ray;
  ray.Resize(1);
  std::copy_n(origin.data(), 3, ray.origin.begin());
  std::copy_n(direction.data(), 3, ray.direction.begin());
  ray.spread = {spread};
  return ray;
}

TEST(Footprint, GrowsWithTheDistance) {
  const RayBatch ray = OneRay({-0.5f, 0, 0}, {1, 0, 0}, 0.01f);
  const auto footprint = Footprints(ray, std::vector<std::int64_t>{0, 0},
                                    std::vector<float>{0.5f, 1}, AntiAliasingOptions{1});
  // The standard deviation of a uniform pixel; a unit is a quarter of the cube.
  EXPECT_NEAR(footprint[0], 0.25 * 0.01 * 0.5 / std::sqrt(12.0), 1e-8);
  EXPECT_NEAR(footprint[1], 2 * footprint[0], 1e-8);
}

TEST(Footprint, IsContractedPerpendicularToTheRadius) {
  const RayBatch ray = OneRay({0, 0, 0}, {0, 0, 1}, 0.01f);
  const auto footprint =
      Footprints(ray, std::vector<std::int64_t>{0}, std::vector<float>{8}, AntiAliasingOptions{1});
  // The sphere of radius 8 is contracted to radius 2 - 1/8.
  EXPECT_NEAR(footprint[0], 0.25 * 0.01 * (2 - 1.0 / 8) / std::sqrt(12.0), 1e-8);
}

TEST(Footprint, WeighsLevelsByErf) {
  kernels::HashGridOptions options;
  options.levels = 3;
  options.base_resolution = 10;
  options.max_resolution = 1000;
  const auto layout = kernels::MakeHashGridLayout(options);
  const std::vector<float> footprint = {0, 0.01f};
  const auto weights = AntiAliasingWeights(layout, footprint);
  ASSERT_EQ(weights.size(), 6u);
  for (int l = 0; l < 3; ++l) EXPECT_EQ(weights[l], 1);
  EXPECT_NEAR(weights[3], std::erf(10 / std::sqrt(8.0)), 1e-6);
  EXPECT_NEAR(weights[4], std::erf(1 / std::sqrt(8.0)), 1e-6);
  EXPECT_NEAR(weights[5], std::erf(0.1 / std::sqrt(8.0)), 1e-6);
}

TEST(Footprint, IsTheSameInBothEngines) {
  WithFootprint(AntiAliasingOptions()).ExpectTheSame();
  WithFootprint(AntiAliasingOptions(), true).ExpectTheSame();
}

TEST(Footprint, WorksWithPoseRefinement) {
  test::TwoEngines e;
  e.anti_aliasing = AntiAliasingOptions();
  e.pose_refinement = std::make_shared<PoseRefinement>(
      std::vector<CameraPlace>{
          {{2, 0, 0}, {-1, 0, 0}, 0}, {{0, 2, 0}, {0, -1, 0}, 0}, {{0, 0, 2}, {0, 0, -1}, 0}},
      PoseRefinementOptions());
  e.Make(50);
  e.batch.rays.spread.assign(50, 0.03f);
  e.ExpectTheSame();
}

TEST(Footprint, OfSizeZeroChangesNoBit) {
  const test::TwoEngines off = WithFootprint({}), point = WithFootprint(AntiAliasingOptions{0}),
                         on = WithFootprint(AntiAliasingOptions{1});
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    const std::vector<float> plain = (off.*engine)->Render(off.batch.rays).rgb;
    EXPECT_EQ((point.*engine)->Render(point.batch.rays).rgb, plain);
    EXPECT_NE((on.*engine)->Render(on.batch.rays).rgb, plain);
  }
}

// The renderer of lower qualities, without approximations, uses the same footprints as the engine.
TEST(Footprint, IsUsedByThePacketRenderer) {
  const test::TwoEngines e = WithFootprint(AntiAliasingOptions{4}, true);
  RenderQuality exact = RenderQuality::Of(0.999, e.march, e.proposal_options);
  exact.packet = 1;
  exact.samples = e.proposal_options.samples;
  exact.color_share = 0;
  exact.stop_transmittance = e.march.stop_transmittance;
  const PacketRenderer packets(*e.parts, exact);
  const RenderOutput a = e.fused->Render(e.batch.rays), b = packets.Render(e.batch.rays);
  const RenderOutput without = WithFootprint({}, true).fused->Render(e.batch.rays);
  double error = 0, change = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    error = std::max(error, static_cast<double>(std::fabs(a.rgb[i] - b.rgb[i])));
    change = std::max(change, static_cast<double>(std::fabs(a.rgb[i] - without.rgb[i])));
  }
  EXPECT_LT(error, 2e-3);
  EXPECT_GT(change, 0.02);
}

TEST(Footprint, SpreadIsTheDistanceBetweenNeighbouringRays) {
  const Camera camera = PinholeFromFov(64, 48, 0.8);
  const std::vector<std::int64_t> pixels = {24 * 64 + 32, 24 * 64 + 33, 2 * 64 + 3, 3 * 64 + 3};
  const RayBatch rays =
      RaysOfPixels(camera, Eigen::Isometry3d::Identity(), pixels, Eigen::Vector3f::Zero()).rays;
  const auto distance = [&](int a, int b) {
    return (Eigen::Vector3f(&rays.direction[3 * a]) - Eigen::Vector3f(&rays.direction[3 * b]))
        .norm();
  };
  EXPECT_NEAR(rays.spread[0], distance(0, 1), 0.01f * rays.spread[0]);
  EXPECT_NEAR(rays.spread[2], distance(2, 3), 0.1f * rays.spread[2]);
}

}  // namespace
}  // namespace nerf
