// Light reflected by surfaces, where it is hard: rows 51, 52 and 56 to 60 of the hard cases.
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "nerf/geometry/directions.h"
#include "nerf/relight/surface_shading.h"
#include "nerf/selfcheck/numeric_case.h"

namespace nerf {
namespace {

constexpr int kDirectionCount = 512;

torch::Tensor RowsOf(const std::vector<Eigen::Vector3d>& vectors) {
  torch::Tensor rows = torch::empty({static_cast<std::int64_t>(vectors.size()), 3}, torch::kDouble);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::copy_n(vectors[i].data(), 3, rows.data_ptr<double>() + 3 * i);
  }
  return rows;
}

torch::Tensor EvenDirections(int count) {
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) directions.push_back(FibonacciDirection(i, count));
  return RowsOf(directions);
}

// The same radiance from everywhere.
ArrivingLight Furnace(int count) {
  ArrivingLight light;
  light.directions = EvenDirections(count);
  light.radiance = torch::ones({count, 3}, torch::kDouble);
  return light;
}

// A surface seen at some cosines.
SurfaceBatch SeenAt(const std::vector<double>& cosines) {
  std::vector<Eigen::Vector3d> normals, to_camera;
  const Eigen::Matrix3d axes = WorldFromSurface(Eigen::Vector3d(0.3, -0.5, 0.8).normalized());
  for (const double cosine : cosines) {
    normals.push_back(axes.col(2));
    to_camera.push_back(axes * Eigen::Vector3d(std::sqrt(1 - cosine * cosine), 0, cosine));
  }
  return {RowsOf(normals), RowsOf(to_camera)};
}

MaterialBatch Coated(std::int64_t points, double color, double roughness, double metallic) {
  return {torch::full({points, 3}, color, torch::kDouble),
          torch::full({points}, roughness, torch::kDouble),
          torch::full({points}, metallic, torch::kDouble)};
}

double Largest(const torch::Tensor& tensor) { return tensor.abs().max().item<double>(); }

// Row 51: a sun that sets goes out without a step, and light that coincides with the camera, or
// comes from behind it, is finite, with its gradients.
double GrazingLightIsFinite() {
  WorstError worst;
  const torch::Tensor normal = RowsOf({Eigen::Vector3d::UnitZ()});
  for (const double n_l : {1.0, 1e-3, 1e-12, 0.0, -1e-12, -1.0}) {
    for (const double n_v : {1.0, 1e-3, 1e-7, 0.0}) {
      for (const double side : {1.0, -1.0}) {
        const auto at = [](double cosine, double x) {
          return RowsOf({Eigen::Vector3d(x * std::sqrt(1 - cosine * cosine), 0, cosine)});
        };
        std::vector<torch::Tensor> inputs = {normal.clone(),
                                             torch::full({1, 3}, 0.5, torch::kDouble),
                                             torch::full({1}, 0.2, torch::kDouble)};
        for (torch::Tensor& input : inputs) input.set_requires_grad(true);
        const torch::Tensor out =
            ShadeFrom({inputs[0], at(n_v, side)},
                      {inputs[1], inputs[2], torch::full({1}, 0.5, torch::kDouble)}, at(n_l, 1),
                      torch::ones({1, 3}, torch::kDouble))
                .Sum();
        worst.RequireFinite(Largest(out));
        if (n_l <= 0) worst.Add(Largest(out));
        if (n_l == 1e-12) worst.Require(Largest(out) < 1e-3);
        for (const torch::Tensor& gradient : torch::autograd::grad({out.sum()}, inputs)) {
          worst.RequireFinite(Largest(gradient));
        }
      }
    }
  }
  return worst.Get();
}

// Row 52: no more than arrives, at both ends of roughness.
double LobesReflectAtMostWhatArrives() {
  WorstError worst;
  const SurfaceBatch surface = SeenAt({1.0, 0.8, 0.5, 0.2, 0.05});
  for (const double roughness : {kLeastRoughness, 0.3, 0.6, 1.0}) {
    for (const double metallic : {0.0, 1.0}) {
      const ReflectedLight out =
          Shade(surface, Coated(5, 1, roughness, metallic), Furnace(kDirectionCount));
      worst.Add(std::max(0.0, out.Sum().max().item<double>() - 1));
      worst.Require(out.specular.min().item<double>() >= 0);
    }
  }
  return worst.Get();
}

// Row 56: black and white are in range, and can change.
double AlbedoAtItsEndsHasAGradient() {
  WorstError worst;
  for (const double color : {0.0, 1.0}) {
    MaterialBatch material = Coated(2, color, 0.5, 0);
    material.base_color.set_requires_grad(true);
    const torch::Tensor out = Shade(SeenAt({0.9, 0.4}), material, Furnace(64)).Sum();
    const torch::Tensor gradient = torch::autograd::grad({out.sum()}, {material.base_color})[0];
    worst.Require(gradient.min().item<double>() > 0.1);
    worst.Require(out.min().item<double>() >= 0);
  }
  return worst.Get();
}

// Row 57: Lambert's white stays white, and below a coat it does but for what the coat scatters
// twice.
double MattWhiteStaysWhite() {
  WorstError worst;
  const SurfaceBatch surface = SeenAt({1.0, 0.6, 0.1});
  const MaterialBatch matt{torch::ones({3, 3}, torch::kDouble), {}, {}};
  worst.Add(Largest(Shade(surface, matt, Furnace(kDirectionCount)).Sum() - 1));
  return worst.Get();
}
double CoatedWhiteStaysWhite() {
  return Largest(
      Shade(SeenAt({1.0, 0.8, 0.6}), Coated(3, 1, 0.4, 0), Furnace(4 * kDirectionCount)).Sum() - 1);
}

// Row 58.
double CameraAndLightCanBeExchanged() {
  WorstError worst;
  const Eigen::Vector3d n = Eigen::Vector3d(0.1, 0.2, 1).normalized();
  const Eigen::Vector3d a = Eigen::Vector3d(0.7, 0.1, 0.5).normalized();
  const Eigen::Vector3d b = Eigen::Vector3d(-0.3, 0.6, 0.8).normalized();
  for (const double roughness : {0.1, 0.4, 1.0}) {
    const auto reflected = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return ShadeFrom({RowsOf({n}), RowsOf({to})}, Coated(1, 0.7, roughness, 0.3), RowsOf({from}),
                       torch::ones({1, 3}, torch::kDouble))
                 .Sum()[0][0]
                 .item<double>() /
             n.dot(from);
    };
    worst.AddRelative(reflected(a, b), reflected(b, a));
  }
  return worst.Get();
}

ArrivingLight ColouredLight() {
  ArrivingLight light = Furnace(256);
  light.radiance = light.radiance * (1.5 + light.directions);
  return light;
}

// Row 59: only the product of light and albedo shows.
double TwiceTheLightOnHalfTheAlbedoIsTheSame() {
  const SurfaceBatch surface = SeenAt({0.9, 0.4});
  ArrivingLight light = ColouredLight();
  const torch::Tensor before = Shade(surface, Coated(2, 0.6, 0.5, 0), light).diffuse;
  light.radiance = light.radiance * 2;
  return Largest(Shade(surface, Coated(2, 0.3, 0.5, 0), light).diffuse / before - 1);
}

// Row 60.
double TurningEverythingChangesNothing() {
  const SurfaceBatch surface = SeenAt({0.9, 0.4});
  ArrivingLight light = ColouredLight();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  torch::Tensor transposed = torch::empty({3, 3}, torch::kDouble);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) transposed[c][r] = turn(r, c);
  }
  const torch::Tensor before = Shade(surface, Coated(2, 0.6, 0.3, 0.5), light).Sum();
  light.directions = torch::matmul(light.directions, transposed);
  const SurfaceBatch turned{torch::matmul(surface.normal, transposed),
                            torch::matmul(surface.to_camera, transposed)};
  return Largest(Shade(turned, Coated(2, 0.6, 0.3, 0.5), light).Sum() / before - 1);
}

}  // namespace

std::vector<NumericCase> ShadingCases() {
  const std::string relative = "radiance, relative", radiance = "radiance";
  return {
      {"GrazingLightIsFinite", radiance, kExact, false, GrazingLightIsFinite},
      {"LobesReflectAtMostWhatArrives", "radiance above 1", Within(3e-3, 3.3e-4), false,
       LobesReflectAtMostWhatArrives},
      {"AlbedoAtItsEndsHasAGradient", "holds", kExact, false, AlbedoAtItsEndsHasAGradient},
      {"MattWhiteStaysWhite", radiance, Within(3e-3, 3.7e-4), false, MattWhiteStaysWhite},
      {"CoatedWhiteStaysWhite", radiance, Within(0.01, 1.4e-3), false, CoatedWhiteStaysWhite},
      {"CameraAndLightCanBeExchanged", relative, Within(8e-16, 1.5e-16, kDoubleRounding), false,
       CameraAndLightCanBeExchanged},
      {"TwiceTheLightOnHalfTheAlbedoIsTheSame", relative, Within(8e-16, 0, kDoubleRounding), false,
       TwiceTheLightOnHalfTheAlbedoIsTheSame},
      {"TurningEverythingChangesNothing", relative, Within(3e-13, 3.1e-14, kDoubleRounding), false,
       TurningEverythingChangesNothing},
  };
}

}  // namespace nerf
