#include "nerf/relight/surface_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "nerf/geometry/directions.h"
#include "nerf/material/metallic_roughness.h"
#include "tests/support/central_differences.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

torch::Tensor Rows(const std::vector<Vector3d>& vectors) {
  torch::Tensor rows = torch::empty({static_cast<std::int64_t>(vectors.size()), 3}, torch::kDouble);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (int k = 0; k < 3; ++k) rows[static_cast<std::int64_t>(i)][k] = vectors[i][k];
  }
  return rows;
}

std::vector<Vector3d> Directions(int count) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) directions.push_back(FibonacciDirection(i, count));
  return directions;
}

// A light of the same radiance from everywhere.
ArrivingLight WhiteLight(std::int64_t points, int directions) {
  ArrivingLight light;
  light.directions = Rows(Directions(directions));
  light.radiance = torch::ones({directions, 3}, torch::kDouble);
  light.visibility = torch::ones({points, directions}, torch::kDouble);
  return light;
}

MaterialBatch Material(const std::vector<Vector3d>& base_color, double roughness, double metallic) {
  const auto points = static_cast<std::int64_t>(base_color.size());
  return {Rows(base_color), torch::full({points}, roughness, torch::kDouble),
          torch::full({points}, metallic, torch::kDouble)};
}

Vector3d At(const torch::Tensor& rows, std::int64_t i) {
  return {rows[i][0].item<double>(), rows[i][1].item<double>(), rows[i][2].item<double>()};
}

// Views of one surface, from above to grazing.
SurfaceBatch Views(const std::vector<double>& cosines) {
  std::vector<Vector3d> normals, to_camera;
  for (const double cosine : cosines) {
    const Eigen::Matrix3d axes = WorldFromSurface(Vector3d(0.3, -0.5, 0.8).normalized());
    normals.push_back(axes.col(2));
    to_camera.push_back(axes * Vector3d(std::sqrt(1 - cosine * cosine), 0, cosine));
  }
  return {Rows(normals), Rows(to_camera)};
}

// The sum over directions against the BRDF integrated by its own samples.
TEST(SurfaceShading, IsTheIntegralOfTheMaterialsBrdf) {
  const auto radiance = [](const Vector3d& direction) {
    return Color(1 + 0.5 * direction.x(), 1 - 0.3 * direction.z() * direction.y(),
                 0.7 + 0.6 * direction.z());
  };
  constexpr int kDirections = 8192;
  const std::vector<double> cosines = {1.0, 0.7, 0.3};
  const SurfaceBatch surface = Views(cosines);
  for (const double metallic : {0.0, 0.4, 1.0}) {
    for (const double roughness : {0.3, 0.6, 1.0}) {
      const Vector3d base(0.8, 0.4, 0.1);
      ArrivingLight light = WhiteLight(3, kDirections);
      for (int d = 0; d < kDirections; ++d) {
        const Color from = radiance(FibonacciDirection(d, kDirections));
        for (int c = 0; c < 3; ++c) light.radiance[d][c] = from[c];
      }
      const ReflectedLight shaded =
          Shade(surface, Material({base, base, base}, roughness, metallic), light);
      const MetallicRoughness brdf(base.array(), roughness, metallic);
      for (int i = 0; i < 3; ++i) {
        const Eigen::Matrix3d axes = WorldFromSurface(At(surface.normal, i));
        const Vector3d w_o = axes.transpose() * At(surface.to_camera, i);
        Color expected = Color::Zero();
        constexpr int kSteps = 300;
        for (int a = 0; a < kSteps; ++a) {
          for (int b = 0; b < kSteps; ++b) {
            const Vector3d w_i = CosineOnHemisphere({(a + 0.5) / kSteps, (b + 0.5) / kSteps});
            expected += brdf.Eval(w_o, w_i) * radiance(axes * w_i) * pi / (kSteps * kSteps);
          }
        }
        const Vector3d sum = At(shaded.diffuse + shaded.specular, i);
        EXPECT_LT((sum.array() - expected).abs().maxCoeff(), 0.02)
            << metallic << ' ' << roughness << ' ' << cosines[i];
      }
    }
  }
}

// Rows 52 and 57 of the hard cases: a white furnace, at both ends of roughness.
TEST(SurfaceShading, ReflectsNoMoreThanArrives) {
  const SurfaceBatch surface = Views({1.0, 0.8, 0.5, 0.2, 0.05});
  const std::vector<Vector3d> white(5, Vector3d::Ones());
  for (const double roughness : {kLeastRoughness, 0.3, 0.6, 1.0}) {
    for (const double metallic : {0.0, 1.0}) {
      const ReflectedLight shaded =
          Shade(surface, Material(white, roughness, metallic), WhiteLight(5, 2048));
      const torch::Tensor sum = shaded.diffuse + shaded.specular;
      EXPECT_LT(sum.max().item<double>(), 1.01) << roughness << ' ' << metallic;
      EXPECT_GT(sum.min().item<double>(), 0.25) << roughness << ' ' << metallic;
    }
  }
}

// Row 57: a white surface in a white furnace stays white, but for what its coat scatters twice.
TEST(SurfaceShading, WhiteStaysWhite) {
  const SurfaceBatch surface = Views({1.0, 0.8, 0.6});
  const std::vector<Vector3d> white(3, Vector3d::Ones());
  for (const double roughness : {0.3, 0.5}) {
    const ReflectedLight shaded =
        Shade(surface, Material(white, roughness, 0), WhiteLight(3, 2048));
    EXPECT_LT((shaded.diffuse + shaded.specular - 1).abs().max().item<double>(), 0.01);
  }
  // Its matt part alone, a Lambert surface behind a coat.
  const ReflectedLight shaded = Shade(surface, Material(white, 1, 0), WhiteLight(3, 2048));
  EXPECT_NEAR(shaded.diffuse[0][0].item<double>(), 0.96, 0.01);
}

// Row 58, of the shading in use: exchanging camera and light changes nothing.
TEST(SurfaceShading, IsReciprocal) {
  const Vector3d n = Vector3d(0.1, 0.2, 1).normalized();
  const Vector3d a = Vector3d(0.7, 0.1, 0.5).normalized(),
                 b = Vector3d(-0.3, 0.6, 0.8).normalized();
  const auto reflected = [&](const Vector3d& from, const Vector3d& to) {
    ArrivingLight light;
    std::vector<Vector3d> directions = Directions(2047);
    directions.push_back(from);
    light.directions = Rows(directions);
    light.radiance = torch::zeros({2048, 3}, torch::kDouble);
    light.radiance[2047] = 1;
    light.visibility = torch::ones({1, 2048}, torch::kDouble);
    const ReflectedLight shaded =
        Shade({Rows({n}), Rows({to})}, Material({Vector3d(0.9, 0.5, 0.2)}, 0.4, 0.3), light);
    return Vector3d(At(shaded.diffuse + shaded.specular, 0) / n.dot(from));
  };
  EXPECT_LT((reflected(a, b) - reflected(b, a)).norm(), 1e-5 * reflected(a, b).norm());
}

// Row 59: light times s and albedo over s are the same picture of a matt surface; row 60: so are
// light, surface and camera that turn together.
TEST(SurfaceShading, OnlyTheProductOfLightAndAlbedoShows) {
  const SurfaceBatch surface = Views({0.9, 0.4});
  ArrivingLight light = WhiteLight(2, 256);
  light.radiance = light.radiance * (1.5 + light.directions);
  const torch::Tensor before =
      Shade(surface, Material({{0.2, 0.4, 0.6}, {0.1, 0.1, 0.1}}, 0.5, 0), light).diffuse;
  light.radiance = light.radiance * 2;
  const torch::Tensor after =
      Shade(surface, Material({{0.1, 0.2, 0.3}, {0.05, 0.05, 0.05}}, 0.5, 0), light).diffuse;
  EXPECT_LT((before - after).abs().max().item<double>(), 1e-12);
}

TEST(SurfaceShading, TurnsWithTheWorld) {
  const SurfaceBatch surface = Views({0.9, 0.4});
  ArrivingLight light = WhiteLight(2, 256);
  light.radiance = light.radiance * (1.5 + light.directions);
  const MaterialBatch material = Material({{0.2, 0.4, 0.6}, {0.7, 0.1, 0.1}}, 0.3, 0.5);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto turned = [&](const torch::Tensor& rows) {
    std::vector<Vector3d> vectors;
    for (std::int64_t i = 0; i < rows.size(0); ++i) vectors.push_back(turn * At(rows, i));
    return Rows(vectors);
  };
  const ReflectedLight before = Shade(surface, material, light);
  light.directions = turned(light.directions);
  const ReflectedLight after =
      Shade({turned(surface.normal), turned(surface.to_camera)}, material, light);
  EXPECT_LT((before.diffuse - after.diffuse).abs().max().item<double>(), 1e-10);
  EXPECT_LT((before.specular - after.specular).abs().max().item<double>(), 1e-10);
}

// Rows 51 and 56: finite values and gradients for grazing and coinciding directions, roughness at
// its ends, albedo 0 and 1.
TEST(SurfaceShading, IsFiniteAtItsEnds) {
  const Vector3d n = Vector3d::UnitZ();
  const std::vector<Vector3d> to_camera = {{1, 0, 0},
                                           {0, 0, 1},
                                           {0, 0, -1},
                                           Vector3d(1, 0, 1e-6).normalized(),
                                           FibonacciDirection(0, 64),
                                           -FibonacciDirection(40, 64)};
  for (const double roughness : {kLeastRoughness, 1.0}) {
    for (const double base : {0.0, 1.0}) {
      SurfaceBatch surface{Rows(std::vector<Vector3d>(6, n)), Rows(to_camera)};
      MaterialBatch material =
          Material(std::vector<Vector3d>(6, Vector3d::Constant(base)), roughness, base);
      ArrivingLight light = WhiteLight(6, 64);
      light.radiance[3] = 1e6;
      for (torch::Tensor* input : {&surface.normal, &material.base_color, &material.roughness,
                                   &material.metallic, &light.radiance}) {
        *input = input->clone().requires_grad_();
      }
      const ReflectedLight shaded = Shade(surface, material, light);
      const torch::Tensor sum = (shaded.diffuse + shaded.specular).sum();
      sum.backward();
      EXPECT_TRUE(std::isfinite(sum.item<double>()));
      EXPECT_GE(shaded.specular.min().item<double>(), 0);
      for (const torch::Tensor& input : {surface.normal, material.base_color, material.roughness,
                                         material.metallic, light.radiance}) {
        EXPECT_TRUE(torch::isfinite(input.grad()).all().item<bool>());
      }
      // An albedo at its end is not dead.
      EXPECT_GT(material.base_color.grad().abs().min().item<double>(), 0);
    }
  }
}

TEST(SurfaceShading, BlackEnvironmentGivesBlack) {
  ArrivingLight light = WhiteLight(2, 64);
  light.radiance.zero_();
  const ReflectedLight shaded =
      Shade(Views({1.0, 0.3}), Material({{1, 1, 1}, {0.5, 0.2, 0.9}}, 0.5, 0.5), light);
  EXPECT_EQ((shaded.diffuse + shaded.specular).abs().max().item<double>(), 0);
}

// What stands in the way counts in place of the environment behind it.
TEST(SurfaceShading, IndirectLightTakesThePlaceOfTheEnvironment) {
  const SurfaceBatch surface = Views({0.8});
  const MaterialBatch material = Material({{0.6, 0.5, 0.4}}, 0.5, 0.2);
  ArrivingLight light = WhiteLight(1, 128);
  const ReflectedLight open = Shade(surface, material, light);
  light.visibility = (torch::arange(128) % 2 == 0).to(torch::kDouble).unsqueeze(0);
  const ReflectedLight shadowed = Shade(surface, material, light);
  EXPECT_LT(shadowed.diffuse.sum().item<double>(), 0.7 * open.diffuse.sum().item<double>());
  light.nearby = (1 - light.visibility).unsqueeze(2).expand({1, 128, 3}).contiguous();
  const ReflectedLight closed = Shade(surface, material, light);
  EXPECT_LT((closed.diffuse - open.diffuse).abs().max().item<double>(), 1e-12);
  EXPECT_LT((closed.specular - open.specular).abs().max().item<double>(), 1e-12);
}

TEST(SurfaceShading, GradientsAreThoseOfCentralDifferences) {
  SurfaceBatch surface = Views({0.9, 0.5, 0.2});
  MaterialBatch material = Material({{0.2, 0.5, 0.7}, {0.9, 0.3, 0.1}, {0.4, 0.4, 0.4}}, 0.45, 0.3);
  ArrivingLight light = WhiteLight(3, 96);
  light.radiance = light.radiance * (1.5 + light.directions);
  light.visibility = (torch::arange(3 * 96).view({3, 96}) % 3 != 0).to(torch::kDouble);
  light.nearby = (1 - light.visibility).unsqueeze(2) * 0.3 * torch::ones({1, 1, 3});
  light.nearby = light.nearby.to(torch::kDouble);
  const std::vector<torch::Tensor*> inputs = {&surface.normal, &material.base_color,
                                              &material.roughness, &material.metallic,
                                              &light.radiance};
  for (torch::Tensor* input : inputs) *input = input->clone().requires_grad_();
  const auto value = [&] {
    const ReflectedLight shaded = Shade(surface, material, light);
    return (shaded.diffuse.square() + 2 * shaded.specular.square()).sum();
  };
  for (torch::Tensor* input : inputs) {
    test::ExpectGradientMatchesCentralDifferences(value, *input, 1e-6, 1e-5);
  }
}

}  // namespace
}  // namespace nerf
