#include "nerf/geometry/rays.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "nerf/base/input_error.h"

namespace nerf {

void CheckCameraCentre(const Eigen::Vector3d& centre_in_normalized, const std::string& view) {
  // Written so that NaN does not pass.
  if (centre_in_normalized.lpNorm<1>() <= static_cast<double>(kFarthestOrigin)) return;
  throw InputError(
      "{}: the camera is {:.0e} times the size of the scene away from it; correct its pose or unit",
      view, centre_in_normalized.norm());
}

void CheckRays(const RayBatch& rays) {
  const auto finite = [](std::span<const float> values) {
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
  };
  if (!rays.spread.empty() && rays.spread.size() != rays.jitter.size()) {
    throw std::invalid_argument(
        fmt::format("{} spreads for {} rays", rays.spread.size(), rays.jitter.size()));
  }
  for (std::int64_t r = 0; r < rays.Size(); ++r) {
    const std::span direction(&rays.direction[3 * r], 3);
    const double length =
        std::hypot(static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                   static_cast<double>(direction[2]));
    const char* wrong = nullptr;
    const bool near = std::ranges::all_of(std::span(&rays.origin[3 * r], 3),
                                          [](float x) { return std::fabs(x) <= kFarthestOrigin; });
    if (!near) wrong = "origin is not finite, or beyond 1e9";
    if (!(std::fabs(length - 1) <= 1e-3)) wrong = "direction is not a unit vector";
    if (!finite({&rays.background[3 * r], 3})) wrong = "background is not finite";
    if (!(rays.jitter[r] >= 0 && rays.jitter[r] <= 1)) wrong = "jitter is not in [0,1]";
    if (!rays.spread.empty() && !(rays.spread[r] >= 0 && std::isfinite(rays.spread[r]))) {
      wrong = "spread is not finite, or negative";
    }
    if (wrong != nullptr) throw std::invalid_argument(fmt::format("ray {}: its {}", r, wrong));
  }
}

}  // namespace nerf
