#include "nerf/render/ray_gradient.h"

#include <Eigen/Core>
#include <cmath>

namespace nerf {

using Eigen::Vector3f;

torch::Tensor SamplePositions(const torch::Tensor& origin, const torch::Tensor& direction,
                              const torch::Tensor& ray, const torch::Tensor& t) {
  const torch::Tensor x =
      origin.index_select(0, ray) + t.unsqueeze(1) * direction.index_select(0, ray);
  const torch::Tensor r = x.norm(2, 1, true).clamp_min(1);
  return 0.25 * ((2 - 1 / r) / r * x) + 0.5;
}

void AddToRays(const RayBatch& rays, std::span<const std::int64_t> ray, std::span<const float> t,
               std::span<const float> dL_dposition, std::span<const float> dL_dlog_sigma,
               RayGradient& gradient) {
  for (std::size_t i = 0; i < ray.size(); ++i) {
    const std::int64_t at = 3 * ray[i];
    const Vector3f direction(&rays.direction[at]);
    const Vector3f x = Vector3f(&rays.origin[at]) + t[i] * direction;
    Vector3f dL_dx = 0.25f * Vector3f(&dL_dposition[3 * i]);
    if (const float square = x.squaredNorm(); square > 1) {
      // The chain rule through y = g(r) x with g = 2/r - 1/r^2, and the term -2 log r of log sigma.
      const float inverse = 1 / std::sqrt(square);
      const float g = (2 - inverse) * inverse;
      const float dg_dr = 2 * inverse * inverse * (inverse - 1);
      dL_dx = g * dL_dx + (dg_dr * inverse * x.dot(dL_dx)) * x;
      dL_dx -= (2 * inverse * inverse * dL_dlog_sigma[i]) * x;
    }
    for (int axis = 0; axis < 3; ++axis) {
      gradient.origin[at + axis] += dL_dx[axis];
      gradient.direction[at + axis] += t[i] * dL_dx[axis];
    }
  }
}

}  // namespace nerf
