#include "nerf/relight/lamps.h"

#include <gtest/gtest.h>

#include <numbers>

#include "nerf/geometry/level_set_mesh.h"
#include "nerf/relight/surface_shading.h"

namespace nerf {
namespace {

ScalarGrid BallGrid() {
  ScalarGrid grid;
  grid.cell = 0.1;
  grid.origin = Eigen::Vector3d::Constant(-1);
  grid.size = Eigen::Vector3i::Constant(21);
  for (int z = 0; z < 21; ++z) {
    for (int y = 0; y < 21; ++y) {
      for (int x = 0; x < 21; ++x) {
        grid.values.push_back(static_cast<float>(grid.PositionOf(x, y, z).norm() - 0.5));
      }
    }
  }
  return grid;
}

TEST(LampTable, SunsAndLampsOfEachGroup) {
  const LampTable lamps({{DirectionalLight{Eigen::Vector3d::UnitX(), {1, 2, 3}}},
                         {PointLight{{0, 0, 2}, {8, 4, 2}}, DirectionalLight{}}});
  ASSERT_EQ(lamps.Most(), 2);
  const torch::Tensor positions = torch::zeros({2, 3});
  const torch::Tensor group = torch::tensor({0, 1}, torch::kLong);
  const LampLight first = lamps.At(positions, group, 0);
  EXPECT_TRUE(
      torch::allclose(first.to_light, torch::tensor({1.f, 0.f, 0.f, 0.f, 0.f, 1.f}).view({2, 3})));
  // Of the lamp, I / d^2.
  EXPECT_TRUE(torch::allclose(first.irradiance,
                              torch::tensor({1.f, 2.f, 3.f, 2.f, 1.f, .5f}).view({2, 3})));
  const LampLight second = lamps.At(positions, group, 1);
  EXPECT_EQ(second.irradiance[0].abs().sum().item<float>(), 0);  // the first group has one
  EXPECT_NEAR(second.irradiance[1][0].item<double>(), std::numbers::pi, 1e-5);
}

TEST(LampTable, ALampAtThePointIsFinite) {
  const LampTable lamps({{PointLight{{0, 0, 0}, {1, 1, 1}}}});
  const LampLight light = lamps.At(torch::zeros({1, 3}), torch::zeros({1}, torch::kLong), 0);
  EXPECT_TRUE(torch::isfinite(light.irradiance).all().item<bool>());
  EXPECT_TRUE(torch::isfinite(light.to_light).all().item<bool>());
}

TEST(LampTable, ShadowsOfABall) {
  const Mesh ball = LevelSetMesh(BallGrid(), 0);
  const MeshRays rays(ball);
  // In the shadow of the sun behind the ball; beside it; between the ball and a lamp.
  const torch::Tensor positions =
      torch::tensor({0.f, 0.f, -.9f, .9f, 0.f, -.9f, 0.f, 0.f, .9f}).view({3, 3});
  const torch::Tensor normals = torch::tensor({0.f, 0.f, 1.f}).expand({3, 3}).contiguous();
  const torch::Tensor group = torch::zeros({3}, torch::kLong);
  const LampTable sun({{DirectionalLight{Eigen::Vector3d::UnitZ(), {1, 1, 1}}}});
  const torch::Tensor of_sun = sun.Visibility(positions, normals, group, rays, 0.01f);
  EXPECT_TRUE(torch::equal(of_sun.squeeze(1), torch::tensor({0.f, 1.f, 1.f})));
  // What is behind a lamp does not shadow it.
  const LampTable lamp({{PointLight{{0, 0, -0.7}, {1, 1, 1}}}});
  const torch::Tensor of_lamp = lamp.Visibility(positions, normals, group, rays, 0.01f);
  EXPECT_TRUE(torch::equal(of_lamp.squeeze(1), torch::tensor({1.f, 1.f, 0.f})));
}

// A sun is the limit of an environment with light from one direction.
TEST(ShadeFrom, IsTheLimitOfOneBrightDirection) {
  const std::int64_t count = 1 << 14;
  ArrivingLight light;
  const torch::TensorOptions options = torch::kDouble;
  const double z = 0.6;
  light.directions = torch::zeros({count, 3}, options);
  light.directions.select(1, 2).fill_(-1);
  light.directions[0] = torch::tensor({0.8, 0.0, z}, options);
  light.radiance = torch::zeros({count, 3}, options);
  // Irradiance pi: radiance times the solid angle 4 pi / count.
  light.radiance[0].fill_(static_cast<double>(count) / 4);
  const SurfaceBatch surface{torch::tensor({0.0, 0.0, 1.0}, options).view({1, 3}),
                             torch::tensor({-0.6, 0.0, 0.8}, options).view({1, 3})};
  const MaterialBatch material{torch::tensor({0.5, 0.3, 0.2}, options).view({1, 3}),
                               torch::full({1}, 0.6, options), torch::full({1}, 0.25, options)};
  const ReflectedLight of_map = Shade(surface, material, light);
  const ReflectedLight of_sun = ShadeFrom(surface, material, light.directions.slice(0, 0, 1),
                                          torch::full({1, 3}, std::numbers::pi, options));
  EXPECT_TRUE(torch::allclose(of_map.diffuse, of_sun.diffuse, 1e-9, 1e-12));
  EXPECT_TRUE(torch::allclose(of_map.specular, of_sun.specular, 2e-3, 1e-6));
}

TEST(ShadeFrom, GradientsMatchCentralDifferences) {
  const torch::TensorOptions options = torch::kDouble;
  torch::manual_seed(1);
  std::vector<torch::Tensor> inputs = {
      torch::tensor({0.1, 0.2, 0.97, 0.3, -0.2, 0.93}, options).view({2, 3}),  // normal
      torch::tensor({0.4, 0.3, 0.2, 0.7, 0.6, 0.9}, options).view({2, 3}),     // base colour
      torch::tensor({0.3, 0.8}, options), torch::tensor({0.2, 0.7}, options),  // coat
      torch::tensor({3.0, 2.0, 1.0, 0.5, 1.5, 2.5}, options).view({2, 3})};    // irradiance
  const torch::Tensor to_camera =
      torch::tensor({0.0, 0.6, 0.8, -0.6, 0.0, 0.8}, options).view({2, 3});
  const torch::Tensor to_light =
      torch::tensor({0.8, 0.0, 0.6, 0.0, -0.6, 0.8}, options).view({2, 3});
  const auto loss = [&] {
    return (ShadeFrom({inputs[0], to_camera}, {inputs[1], inputs[2], inputs[3]}, to_light,
                      inputs[4])
                .Sum() *
            torch::tensor({1.0, -0.5, 2.0}, options))
        .sum();
  };
  for (torch::Tensor& input : inputs) input.set_requires_grad(true);
  const auto gradients = torch::autograd::grad({loss()}, inputs);
  const torch::NoGradGuard no_grad;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const torch::Tensor flat = inputs[k].view({-1});
    for (std::int64_t i = 0; i < flat.numel(); ++i) {
      constexpr double kStep = 1e-6;
      const double at = flat[i].item<double>();
      flat[i] = at + kStep;
      const double above = loss().item<double>();
      flat[i] = at - kStep;
      const double below = loss().item<double>();
      flat[i] = at;
      EXPECT_NEAR(gradients[k].view({-1})[i].item<double>(), (above - below) / (2 * kStep), 1e-6)
          << "input " << k << ", element " << i;
    }
  }
}

TEST(ShadeFrom, AMattSurfaceIsLamberts) {
  const SurfaceBatch surface{torch::tensor({0.f, 0.f, 1.f}).view({1, 3}),
                             torch::tensor({0.f, 0.6f, 0.8f}).view({1, 3})};
  const MaterialBatch material{torch::full({1, 3}, 0.5f), {}, {}};
  const ReflectedLight out =
      ShadeFrom(surface, material, torch::tensor({0.6f, 0.f, 0.8f}).view({1, 3}),
                torch::full({1, 3}, static_cast<float>(std::numbers::pi)));
  EXPECT_NEAR(out.diffuse[0][0].item<double>(), 0.5 * 0.8, 1e-6);
  EXPECT_EQ(out.specular.abs().sum().item<float>(), 0);
}

}  // namespace
}  // namespace nerf
