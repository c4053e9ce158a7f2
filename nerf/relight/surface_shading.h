#pragma once

#include "nerf/field/libtorch.h"

namespace nerf {

// Reflection at surface points, the definition as autograd operations, in float or double, of the
// material that material/metallic_roughness.h describes.
//
// The integral over incident light is a sum over fixed directions of equal solid angle. A lobe that
// is narrower than the distance between them is widened to it: alpha'^2 = alpha^2 + s^2, where s is
// LeastAlpha. Where the sum over such a lobe is more than 1 nevertheless, it is divided by it.
inline constexpr double kDielectricReflectance = 0.04;
inline constexpr double kLeastRoughness = 0.09;  // of what is fitted

// [P] points that a camera sees.
struct SurfaceBatch {
  torch::Tensor normal;     // [P,3] unit
  torch::Tensor to_camera;  // [P,3] unit
};

// Without a coat, of which roughness and metallic are undefined, a surface is matt (Lambert's).
struct MaterialBatch {
  torch::Tensor base_color;  // [P,3] in [0,1]
  torch::Tensor roughness;   // [P] in [kLeastRoughness, 1]
  torch::Tensor metallic;    // [P] in [0,1]

  bool IsMatt() const { return !roughness.defined(); }
  MaterialBatch Rows(std::int64_t begin, std::int64_t end) const;
};

// What arrives at the points from each of D directions.
struct ArrivingLight {
  torch::Tensor directions;  // [D,3] unit, towards the light
  torch::Tensor radiance;    // [D,3] of the environment; undefined: `nearby` has all
  torch::Tensor visibility;  // [P,D] share of it that arrives; undefined: all of it
  torch::Tensor nearby;      // [P,D,3] radiance of what stands in the way; undefined: none
};

// [P,3] radiance towards the camera, by lobe.
struct ReflectedLight {
  torch::Tensor diffuse, specular;

  torch::Tensor Sum() const { return diffuse + specular; }
};

// The width s of lobes that `directions` directions resolve.
double LeastAlpha(std::int64_t directions);

// Differentiable in the normals, the materials and the radiances. Where a normal faces away from
// the camera, n.v is taken as 0.001. Throws c10::Error on a shape mismatch.
ReflectedLight Shade(const SurfaceBatch& surface, const MaterialBatch& material,
                     const ArrivingLight& light);

// The same of a light of no extent, a sun or a lamp; its lobe has the width of the material.
//   to_light    [P,3] unit
//   irradiance  [P,3] on a surface that faces it; 0 in its shadow
ReflectedLight ShadeFrom(const SurfaceBatch& surface, const MaterialBatch& material,
                         const torch::Tensor& to_light, const torch::Tensor& irradiance);

}  // namespace nerf
