#include "nerf/effects/footprint.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

// Of a uniform distribution over a unit.
constexpr float kDeviation = 0.28867513f;
// Half a unit of the cube is two of contracted space.
constexpr float kCubeFromContracted = 0.25f;
// From here on erf is 1 in float.
constexpr float kSharp = 4;

}  // namespace

void FootprintOptions::Check() const {
  if (pixels >= 0 && pixels <= 8) return;
  throw InputError("config: effects.footprint.pixels is {}; use 0 to 8", pixels);
}

std::vector<float> Footprints(const RayBatch& rays, std::span<const std::int64_t> ray,
                              std::span<const float> t, const FootprintOptions& options) {
  std::vector<float> footprint(t.size(), 0.0f);
  if (rays.spread.empty()) return footprint;
  const float unit = static_cast<float>(options.pixels) * kDeviation * kCubeFromContracted;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::int64_t r = ray[i];
    const Eigen::Vector3f x =
        Eigen::Vector3f(&rays.origin[3 * r]) + t[i] * Eigen::Vector3f(&rays.direction[3 * r]);
    const float inverse = 1 / std::max(1.0f, x.stableNorm());
    footprint[i] = unit * rays.spread[r] * t[i] * (2 - inverse) * inverse;
  }
  return footprint;
}

std::vector<float> LevelShares(const kernels::HashGridLayout& layout,
                               std::span<const float> footprint) {
  const std::size_t levels = layout.levels.size();
  std::vector<float> shares(levels * footprint.size());
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    // Of a point infinite, whose error function is 1.
    const float reach = 1 / (std::sqrt(8.0f) * footprint[i]);
    for (std::size_t l = 0; l < levels; ++l) {
      const float x = reach / static_cast<float>(layout.levels[l].resolution);
      shares[i * levels + l] = x > kSharp ? 1.0f : std::erf(x);
    }
  }
  return shares;
}

}  // namespace nerf
