#include "nerf/relight/surface_shading.h"

#include <cmath>
#include <numbers>

namespace nerf {
namespace {

constexpr double kLeastCosine = 1e-3;
// The mean of F_d over the hemisphere, weighted by the cosine.
constexpr double kMeanReflectance = kDielectricReflectance + (1 - kDielectricReflectance) / 21;
// LeastAlpha, in distances between neighbouring directions.
constexpr double kLobeInDistances = 0.6;

torch::Tensor FifthPower(const torch::Tensor& x) {
  const torch::Tensor square = x * x;
  return square * square * x;
}

// 1 - F_d: the share of light that enters a dielectric.
torch::Tensor Entering(const torch::Tensor& cosine) {
  return (1 - kDielectricReflectance) * (1 - FifthPower(1 - cosine));
}

// sum over d of weight [P,D] times what arrives, [P,3].
torch::Tensor Gather(const torch::Tensor& weight, const ArrivingLight& light) {
  torch::Tensor sum = torch::matmul(weight * light.visibility, light.radiance);
  if (light.indirect.defined()) {
    sum = sum + torch::bmm(weight.unsqueeze(1), light.indirect).squeeze(1);
  }
  return sum;
}

}  // namespace

double LeastAlpha(std::int64_t directions) {
  return kLobeInDistances * std::sqrt(4 * std::numbers::pi / static_cast<double>(directions));
}

ReflectedLight Shade(const SurfaceBatch& surface, const MaterialBatch& material,
                     const ArrivingLight& light) {
  const std::int64_t points = surface.normal.size(0), count = light.directions.size(0);
  TORCH_CHECK(surface.normal.sizes() == surface.to_camera.sizes() &&
                  material.base_color.sizes() == surface.normal.sizes() &&
                  material.roughness.size(0) == points && material.metallic.size(0) == points,
              "one normal, direction and material for each of ", points, " points");
  TORCH_CHECK(light.visibility.sizes() == torch::IntArrayRef({points, count}), "visibility is ",
              light.visibility.sizes(), " for ", points, " points and ", count, " directions");

  const torch::Tensor least = torch::full({}, LeastAlpha(count), surface.normal.options());
  const torch::Tensor alpha = material.roughness.square();
  const torch::Tensor a2 = (alpha.square() + least.square()).clamp_max(1).unsqueeze(1);  // [P,1]

  const torch::Tensor nl = torch::matmul(surface.normal, light.directions.t()).clamp_min(0);
  const torch::Tensor nv =
      (surface.normal * surface.to_camera).sum(1, true).clamp_min(kLeastCosine);  // [P,1]
  const torch::Tensor vl = torch::matmul(surface.to_camera, light.directions.t());
  // h = (v + l) / |v + l|, |v + l|^2 = 2 + 2 v.l
  const torch::Tensor inverse = torch::rsqrt((2 + 2 * vl).clamp_min(1e-6));
  const torch::Tensor nh = ((nl + nv) * inverse).clamp(0, 1);
  const torch::Tensor vh = ((1 + vl) * inverse).clamp(0, 1);

  const torch::Tensor spread = nh.square() * (a2 - 1) + 1;
  const torch::Tensor density = a2 / (std::numbers::pi * spread.square());
  const torch::Tensor masking = 0.5 / (nv * torch::sqrt(a2 + (1 - a2) * nl.square()) +
                                       nl * torch::sqrt(a2 + (1 - a2) * nv.square()))
                                          .clamp_min(1e-6);
  const torch::Tensor grazing = FifthPower(1 - vh);

  const double solid_angle = 4 * std::numbers::pi / static_cast<double>(count);
  torch::Tensor lobe = density * masking * nl * solid_angle;
  lobe = lobe / lobe.sum(1, true).clamp_min(1);
  const torch::Tensor facing = Gather(lobe * (1 - grazing), light);
  const torch::Tensor rim = Gather(lobe * grazing, light);
  const torch::Tensor entering = Gather(nl * Entering(nl) * solid_angle, light) * Entering(nv) /
                                 (std::numbers::pi * (1 - kMeanReflectance));

  const torch::Tensor m = material.metallic.unsqueeze(1);
  const torch::Tensor F0 = kDielectricReflectance * (1 - m) + material.base_color * m;
  return {(1 - m) * material.base_color * entering, F0 * facing + rim};
}

}  // namespace nerf
