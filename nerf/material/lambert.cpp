#include "nerf/material/lambert.h"

#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {

using Eigen::Vector3d;

Color Lambert::Eval(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return Color::Zero();
  return albedo_ / std::numbers::pi;
}

std::optional<BrdfSample> Lambert::Sample(const Vector3d& w_o, const Eigen::Array3d& u) const {
  const Vector3d w_i = CosineOnHemisphere(u.head<2>());
  if (w_o.z() <= 0 || w_i.z() <= 0) return std::nullopt;
  return BrdfSample{w_i, albedo_ / std::numbers::pi, w_i.z() / std::numbers::pi};
}

double Lambert::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  return w_o.z() <= 0 || w_i.z() <= 0 ? 0 : w_i.z() / std::numbers::pi;
}

}  // namespace nerf
