#include "nerf/sampling/ray_intervals.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "nerf/sampling/contraction.h"

namespace nerf {
namespace {

// The spacing function of the distance behind the near plane, and its inverse.
float SpacingFromDistance(float t) { return t < 1 ? t : 2 - 1 / t; }
float DistanceFromSpacing(float s) { return s < 1 ? s : 1 / (2 - s); }

}  // namespace

float NormalizedDistance(float t, const MarchOptions& options) {
  const auto near = static_cast<float>(options.near_distance);
  return SpacingFromDistance(t - near) /
         SpacingFromDistance(static_cast<float>(options.far_distance) - near);
}

void EqualIntervals(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                    std::span<float> edges) {
  const Eigen::Vector3f origin(&rays.origin[3 * r]), direction(&rays.direction[3 * r]);
  const auto [near, far] = RangeOfRay(rays, r, options);
  // Quadrature at equally spaced s, where speed times dt/ds stays smooth: outside the unit ball the
  // contraction slows down as fast as the spacing grows. For a very distant `far`, s rounds to 2,
  // whose distance is infinite, so distances are clamped to `far`.
  constexpr int kKnots = 32;
  std::array<float, kKnots + 1> length{};
  const float step = SpacingFromDistance(far - near) / kKnots;
  float before = 0;
  for (int k = 0; k <= kKnots; ++k) {
    const float s = step * static_cast<float>(k);
    const float behind_near = std::min(DistanceFromSpacing(s), far - near);
    const float dt_ds = s < 1 ? 1 : behind_near * behind_near;
    const Eigen::Vector3f x = origin + (near + behind_near) * direction;
    const float speed = dt_ds * (options.unbounded ? ContractedSpeed(x, direction) : 1);
    if (k > 0) length[k] = length[k - 1] + 0.5f * (before + speed) * step;
    before = speed;
  }
  const auto intervals = static_cast<std::int64_t>(edges.size()) - 1;
  int k = 0;
  for (std::int64_t i = 1; i < intervals; ++i) {
    const float share =
        (static_cast<float>(i) + rays.jitter[r] - 0.5f) / static_cast<float>(intervals);
    const float wanted = share * length[kKnots];
    while (k + 1 < kKnots && length[k + 1] < wanted) ++k;
    const float own = length[k + 1] - length[k];
    const float fraction = own > 0 ? std::clamp((wanted - length[k]) / own, 0.0f, 1.0f) : 0.5f;
    edges[i] = std::min(near + DistanceFromSpacing(step * (static_cast<float>(k) + fraction)), far);
  }
  edges.front() = near;
  edges.back() = far;
}

void ResampleIntervals(std::span<const float> edges, std::span<const float> weights, float padding,
                       float jitter, std::span<float> out) {
  const std::size_t intervals = weights.size();
  double sum = 0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  // A histogram without any weight (a ray through empty space) counts as uniform.
  const double scale = sum > 0 ? 1.0 / sum : 0.0;
  const double share = 1.0 / static_cast<double>(intervals);
  const double even = sum > 0 ? static_cast<double>(padding) * share : share;
  const double total = (sum > 0 ? 1.0 : 0.0) + even * static_cast<double>(intervals);

  const auto shares = static_cast<double>(out.size() - 1);
  std::size_t i = 0;
  double before = 0;  // weight in front of interval i
  double own = static_cast<double>(weights[0]) * scale + even;
  for (std::size_t m = 1; m + 1 < out.size(); ++m) {
    const double wanted =
        total * (static_cast<double>(m) + static_cast<double>(jitter) - 0.5) / shares;
    while (i + 1 < intervals && before + own < wanted) {
      before += own;
      ++i;
      own = static_cast<double>(weights[i]) * scale + even;
    }
    const auto fraction = static_cast<float>(std::clamp((wanted - before) / own, 0.0, 1.0));
    // Rounding may exceed the end of the interval.
    out[m] = std::min(edges[i] + fraction * (edges[i + 1] - edges[i]), edges[i + 1]);
  }
  out.front() = edges.front();
  out.back() = edges.back();
}

void ResampleAnnealed(std::span<const float> edges, std::span<const float> weights, float exponent,
                      float padding, float jitter, std::span<float> out) {
  if (exponent >= 1) return ResampleIntervals(edges, weights, padding, jitter, out);
  constexpr std::size_t kMost = 1024;
  std::array<float, kMost> tempered{};
  for (std::size_t i = 0; i < weights.size(); ++i) tempered[i] = std::pow(weights[i], exponent);
  ResampleIntervals(edges, std::span(tempered).first(weights.size()), padding, jitter, out);
}

void PackIntervalsOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                        std::span<const float> edges, std::span<float> position, std::span<float> t,
                        std::span<float> dt) {
  const Eigen::Vector3f origin(&rays.origin[3 * r]), direction(&rays.direction[3 * r]);
  // Inside the unit ball space is not contracted. A ray that misses it has empty intervals at its
  // origin, which may be anywhere; they are clamped, since encodings need positions in the cube.
  const auto contracted = [&](const Eigen::Vector3f& x) -> Eigen::Vector3f {
    return options.unbounded ? Contract(x) : x.cwiseMax(-1.0f).cwiseMin(1.0f);
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    t[i] = 0.5f * (edges[i] + edges[i + 1]);
    dt[i] = edges[i + 1] - edges[i];
    const Eigen::Vector3f x_in_cube = UnitCubeFromContracted(contracted(origin + t[i] * direction));
    std::copy_n(x_in_cube.data(), 3, &position[3 * i]);
  }
}

}  // namespace nerf
