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
  torch::Tensor sum;
  if (light.radiance.defined()) {
    sum = torch::matmul(light.visibility.defined() ? weight * light.visibility : weight,
                        light.radiance);
  }
  if (!light.nearby.defined()) return sum;
  const torch::Tensor nearby = torch::bmm(weight.unsqueeze(1), light.nearby).squeeze(1);
  return sum.defined() ? sum + nearby : nearby;
}

void CheckShapes(const SurfaceBatch& surface, const MaterialBatch& material) {
  const std::int64_t points = surface.normal.size(0);
  const bool has_coat = !material.IsMatt();
  TORCH_CHECK(surface.normal.sizes() == surface.to_camera.sizes() &&
                  material.base_color.sizes() == surface.normal.sizes() &&
                  (!has_coat ||
                   (material.roughness.size(0) == points && material.metallic.size(0) == points)),
              "one normal, direction and material for each of ", points, " points");
}

torch::Tensor CosineToCamera(const SurfaceBatch& surface) {  // [P,1]
  return (surface.normal * surface.to_camera).sum(1, true).clamp_min(kLeastCosine);
}

// The facets that reflect between two directions.
struct Facets {
  torch::Tensor reflected;  // D V n.l: f cos, but for the Fresnel factor
  torch::Tensor grazing;    // fifth power of 1 - v.h
};

// From the cosines between normal, light and camera, and the square of alpha, of shapes that fit.
Facets FacetsOf(const torch::Tensor& nl, const torch::Tensor& nv, const torch::Tensor& vl,
                const torch::Tensor& a2) {
  // h = (v + l) / |v + l|, |v + l|^2 = 2 + 2 v.l
  const torch::Tensor inverse = torch::rsqrt((2 + 2 * vl).clamp_min(1e-6));
  const torch::Tensor nh = ((nl + nv) * inverse).clamp(0, 1);
  const torch::Tensor vh = ((1 + vl) * inverse).clamp(0, 1);
  const torch::Tensor spread = nh.square() * (a2 - 1) + 1;
  const torch::Tensor density = a2 / (std::numbers::pi * spread.square());
  const torch::Tensor masking = 0.5 / (nv * torch::sqrt(a2 + (1 - a2) * nl.square()) +
                                       nl * torch::sqrt(a2 + (1 - a2) * nv.square()))
                                          .clamp_min(1e-6);
  return {density * masking * nl, FifthPower(1 - vh)};
}

// Lambert's f cos.
torch::Tensor MattOf(const torch::Tensor& nl) { return nl / std::numbers::pi; }

// f cos of the base below the coat, of a dielectric of base colour 1.
torch::Tensor BaseOf(const torch::Tensor& nl, const torch::Tensor& nv) {
  return nl * Entering(nl) * Entering(nv) / (std::numbers::pi * (1 - kMeanReflectance));
}

//   base           [P,3] what the base reflects, of a base colour of 1
//   facing, rim    [P,3] what the facets reflect, at normal incidence of F0 1 and beyond it
ReflectedLight Coated(const MaterialBatch& material, const torch::Tensor& base,
                      const torch::Tensor& facing, const torch::Tensor& rim) {
  const torch::Tensor m = material.metallic.unsqueeze(1);
  const torch::Tensor F0 = kDielectricReflectance * (1 - m) + material.base_color * m;
  return {(1 - m) * material.base_color * base, F0 * facing + rim};
}

}  // namespace

MaterialBatch MaterialBatch::Rows(std::int64_t begin, std::int64_t end) const {
  if (IsMatt()) return {base_color.slice(0, begin, end), {}, {}};
  return {base_color.slice(0, begin, end), roughness.slice(0, begin, end),
          metallic.slice(0, begin, end)};
}

double LeastAlpha(std::int64_t directions) {
  return kLobeInDistances * std::sqrt(4 * std::numbers::pi / static_cast<double>(directions));
}

ReflectedLight Shade(const SurfaceBatch& surface, const MaterialBatch& material,
                     const ArrivingLight& light) {
  CheckShapes(surface, material);
  const std::int64_t points = surface.normal.size(0), count = light.directions.size(0);
  TORCH_CHECK(!light.visibility.defined() ||
                  light.visibility.sizes() == torch::IntArrayRef({points, count}),
              "visibility is ", light.visibility.sizes(), " for ", points, " points and ", count,
              " directions");
  TORCH_CHECK(light.radiance.defined() || light.nearby.defined(), "there is no light");
  const double solid_angle = 4 * std::numbers::pi / static_cast<double>(count);
  const torch::Tensor nl = torch::matmul(surface.normal, light.directions.t()).clamp_min(0);
  if (material.IsMatt()) {
    const torch::Tensor matt = material.base_color * Gather(MattOf(nl) * solid_angle, light);
    return {matt, torch::zeros_like(matt)};
  }
  const double least = LeastAlpha(count);
  const torch::Tensor alpha = material.roughness.square();
  const torch::Tensor a2 = (alpha.square() + least * least).clamp_max(1).unsqueeze(1);  // [P,1]
  const torch::Tensor nv = CosineToCamera(surface);
  const torch::Tensor vl = torch::matmul(surface.to_camera, light.directions.t());
  const Facets facets = FacetsOf(nl, nv, vl, a2);
  torch::Tensor lobe = facets.reflected * solid_angle;
  lobe = lobe / lobe.sum(1, true).clamp_min(1);
  return Coated(material, Gather(BaseOf(nl, nv) * solid_angle, light),
                Gather(lobe * (1 - facets.grazing), light), Gather(lobe * facets.grazing, light));
}

ReflectedLight ShadeFrom(const SurfaceBatch& surface, const MaterialBatch& material,
                         const torch::Tensor& to_light, const torch::Tensor& irradiance) {
  CheckShapes(surface, material);
  TORCH_CHECK(
      to_light.sizes() == surface.normal.sizes() && irradiance.sizes() == surface.normal.sizes(),
      "a direction and an irradiance for each of ", surface.normal.size(0), " points");
  const torch::Tensor nl = (surface.normal * to_light).sum(1, true).clamp_min(0);
  if (material.IsMatt()) {
    const torch::Tensor matt = material.base_color * MattOf(nl) * irradiance;
    return {matt, torch::zeros_like(matt)};
  }
  const torch::Tensor nv = CosineToCamera(surface);
  const torch::Tensor vl = (surface.to_camera * to_light).sum(1, true);
  const torch::Tensor a2 = material.roughness.square().square().unsqueeze(1);
  const Facets facets = FacetsOf(nl, nv, vl, a2);
  return Coated(material, BaseOf(nl, nv) * irradiance,
                facets.reflected * (1 - facets.grazing) * irradiance,
                facets.reflected * facets.grazing * irradiance);
}

}  // namespace nerf
