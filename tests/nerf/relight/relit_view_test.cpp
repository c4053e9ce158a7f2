#include "nerf/relight/relit_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/geometry/level_set_mesh.h"
#include "nerf/relight/environment_light.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kBall = 0.6;
constexpr int kCount = 256;

// A ball over a plane, of the materials of an untrained field.
RelightableSurface BallOverPlane() {
  RelightableSurface surface;
  surface.distance.cell = 0.05;
  surface.distance.origin = Eigen::Vector3d::Constant(-1);
  surface.distance.size = Eigen::Vector3i::Constant(41);
  for (int z = 0; z < 41; ++z) {
    for (int y = 0; y < 41; ++y) {
      for (int x = 0; x < 41; ++x) {
        const Eigen::Vector3d p = surface.distance.PositionOf(x, y, z);
        surface.distance.values.push_back(
            static_cast<float>(std::min(p.norm() - kBall, p.z() + 0.8)));
      }
    }
  }
  surface.mesh = LevelSetMesh(surface.distance, 0);
  surface.field = std::make_shared<MaterialField>(
      Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)), 32, false,
      3);
  surface.lights = {{"", torch::ones({kCount, 3}), {}}};
  return surface;
}

// The ball as a camera at a distance of 3 on the x axis sees it; nothing of the plane.
DepthMap SeeBall() {
  DepthMap picture;
  picture.camera = PinholeFromFov(24, 24, 0.5);
  picture.grid_from_camera.setIdentity();
  picture.grid_from_camera.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  picture.grid_from_camera.translation() = Eigen::Vector3d(3, 0, 0);
  picture.distance = picture.opacity = Image(24, 24, 1);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 24; ++x) {
      const auto direction = DirectionFromPixel(picture.camera, {x + 0.5, y + 0.5});
      const double along = direction->z() * 3, under = along * along - 9 + kBall * kBall;
      if (under < 0) continue;
      *picture.opacity.At(x, y) = 1;
      *picture.distance.At(x, y) = static_cast<float>(along - std::sqrt(under));
    }
  }
  return picture;
}

TEST(RelitView, SeesTheSurfaceWithItsNormals) {
  const RelightableSurface surface = BallOverPlane();
  const Relighter relighter(surface);
  const SeenSurface seen = relighter.See(SeeBall());
  ASSERT_GT(seen.pixels.size(), 100u);
  const torch::Tensor outwards = seen.position / seen.position.norm(2, 1, true);
  EXPECT_GT((outwards * seen.surface_normal).sum(1).min().item<float>(), 0.97f);
  EXPECT_LT((seen.position.norm(2, 1) - kBall).abs().max().item<float>(), 0.003f);  // on a facet
  EXPECT_EQ(seen.vertex.size(0), static_cast<std::int64_t>(seen.pixels.size()));
}

TEST(RelitView, ParallelLightMakesADaySideAndANightSide) {
  const RelightableSurface surface = BallOverPlane();
  Relighter relighter(surface);
  const SeenSurface seen = relighter.See(SeeBall());
  torch::Tensor lamp = torch::zeros({kCount, 3});
  // From +y, which is to the right in the picture.
  lamp[LightDirections(kCount).select(1, 1).argmax().item<std::int64_t>()] = 50;
  relighter.SetLight({"", lamp, {}}, 0);
  const RelitPixels relit = relighter.Reflect(seen);
  const torch::Tensor y = seen.surface_normal.select(1, 1);
  const torch::Tensor sum = relit.direct.sum(1);
  EXPECT_GT(sum.masked_select(y > 0.3).min().item<float>(), 0.05f);
  EXPECT_LT(sum.masked_select(y < -0.2).max().item<float>(), 1e-6f);
  EXPECT_LT(relit.indirect.abs().max().item<float>(), 1e-6f);
}

TEST(RelitView, ThePlaneBelowShadowsAndReflects) {
  const RelightableSurface surface = BallOverPlane();
  Relighter relighter(surface);
  const SeenSurface seen = relighter.See(SeeBall());
  relighter.SetLight({"", torch::ones({kCount, 3}), {}}, 2);
  const RelitPixels relit = relighter.Reflect(seen);
  const torch::Tensor z = seen.surface_normal.select(1, 2);
  // Of what faces up nothing is in shadow, of what faces down most; there light bounces.
  EXPECT_GT(relit.visibility.masked_select(z > 0.7).min().item<float>(), 0.95f);
  EXPECT_LT(relit.visibility.masked_select(z < -0.8).max().item<float>(), 0.6f);
  EXPECT_GT(relit.indirect.sum(1).masked_select(z < -0.8).min().item<float>(),
            10 * relit.indirect.sum(1).masked_select(z > 0.8).max().item<float>());
  EXPECT_TRUE(torch::isfinite(relit.direct + relit.indirect + relit.specular).all().item<bool>());
  // White light on what is not white.
  EXPECT_LT((relit.direct + relit.indirect).max().item<float>(), 1.01f);
}

// Row 53: a black environment.
TEST(RelitView, BlackLightIsBlack) {
  const RelightableSurface surface = BallOverPlane();
  Relighter relighter(surface);
  relighter.SetLight({"", torch::zeros({kCount, 3}), {}}, 1);
  const RelitPixels relit = relighter.Reflect(relighter.See(SeeBall()));
  EXPECT_EQ((relit.direct + relit.indirect).abs().max().item<float>(), 0);
}

TEST(RelitView, OfAnEmptyPictureNothingIsSeen) {
  const RelightableSurface surface = BallOverPlane();
  const Relighter relighter(surface);
  DepthMap picture = SeeBall();
  std::ranges::fill(picture.opacity.pixels, 0.0f);
  const SeenSurface seen = relighter.See(picture);
  EXPECT_TRUE(seen.pixels.empty());
  EXPECT_EQ(relighter.Reflect(seen).direct.size(0), 0);
}

// A light that is written as a map, and read from it, is the same, but for its resolution.
TEST(EnvironmentLight, AWrittenMapIsTheLight) {
  const torch::Tensor directions = LightDirections(kCount);
  const torch::Tensor light = 1 + 0.8 * directions;
  const Eigen::Matrix3d axes = MapFromFrame(
      Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 1, 1).normalized()).toRotationMatrix());
  const EnvironmentMap map(EnvironmentImage(light, 32, axes), "written");
  EXPECT_LT((RadianceFrom(map, directions, axes) - light).abs().max().item<float>(), 0.1f);
}

}  // namespace
}  // namespace nerf
