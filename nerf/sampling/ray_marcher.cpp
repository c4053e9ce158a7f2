#include "nerf/sampling/ray_marcher.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/sampling/contraction.h"

namespace nerf {

namespace {

// Lower bound of a speed that is divided by.
constexpr float kLowestSpeed = 1e-20f;

// Speed and position of a ray in contracted space. Faster than ContractedSpeed and Contract, since
// squares of distances that poses can have do not overflow.
struct Contracted {
  static float Speed(const Eigen::Vector3f& x, const Eigen::Vector3f& direction) {
    const float square = x.squaredNorm();
    if (square <= 1.0f) return 1.0f;
    const float inverse = 1.0f / std::sqrt(square);
    const float radial = x.dot(direction) * inverse;
    const float along = radial * inverse * inverse;
    const float across = (2.0f - inverse) * inverse;
    return std::sqrt(along * along + across * across * std::max(0.0f, 1.0f - radial * radial));
  }
  // An upper bound of the speed at x in any direction: the tangential speed, which decreases with
  // r = |x|. The radial speed is 1/r^2.
  static float HighestSpeed(const Eigen::Vector3f& x) {
    const float r = x.norm();
    return r <= 1 ? 1.0f : (2.0f - 1.0f / r) / r;
  }
  static Eigen::Vector3f InCube(const Eigen::Vector3f& x) {
    const float square = x.squaredNorm();
    if (square <= 1.0f) return UnitCubeFromContracted(x);
    const float inverse = 1.0f / std::sqrt(square);
    return UnitCubeFromContracted(((2.0f - inverse) * inverse) * x);
  }
};

// The same inside the unit ball, where space is not contracted.
struct UnitBall {
  static float Speed(const Eigen::Vector3f&, const Eigen::Vector3f&) { return 1; }
  static float HighestSpeed(const Eigen::Vector3f&) { return 1; }
  static Eigen::Vector3f InCube(const Eigen::Vector3f& x) { return UnitCubeFromContracted(x); }
};

template <class Space>
void March(const RayBatch& rays, std::int64_t r, const OccupancyGrid& grid,
           const MarchOptions& options, RaySamples& out) {
  const Eigen::Vector3f origin(&rays.origin[3 * r]), direction(&rays.direction[3 * r]);
  const float step = options.StepLength();
  const auto [near_distance, far_distance] = RangeOfRay(rays, r, options);
  const float nearest = -origin.dot(direction);  // where the ray is closest to the centre
  float t = near_distance;
  float fraction = 1.0f - rays.jitter[r];
  while (t < far_distance) {
    const float speed = Space::Speed(origin + t * direction, direction);
    // At a great distance the contracted point hardly moves; a step is bounded so that it is not
    // longer than the ray before it.
    const float longest = std::min(std::max(t, 1.0f), far_distance - t);
    const float dt = std::min(fraction * step / std::max(speed, kLowestSpeed), longest);
    fraction = 1.0f;
    const float middle = t + 0.5f * dt;
    const Eigen::Vector3f x_in_cube = Space::InCube(origin + middle * direction);
    if (grid.Occupied(x_in_cube)) {
      out.position.insert(out.position.end(), {x_in_cube[0], x_in_cube[1], x_in_cube[2]});
      out.t.push_back(middle);
      out.dt.push_back(dt);
    } else if (const float free = grid.FreeRadius(x_in_cube); free > 2 * step) {
      // Skips empty space in one step, as far as the highest speed on the way allows: that at the
      // point of the way closest to the centre.
      const auto reach = [&](float at) {
        return free / std::max(Space::HighestSpeed(origin + at * direction), kLowestSpeed);
      };
      const float guess = middle + reach(middle);
      const float innermost = std::clamp(nearest, middle, guess);
      t = std::max(t + dt, middle + reach(innermost));
      continue;
    }
    // Advances even where a step is below the precision of t.
    t = std::max(t + dt, std::nextafter(t, far_distance));
  }
}

}  // namespace

RayRange RangeOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options) {
  const auto near = static_cast<float>(options.near_distance);
  const auto far = static_cast<float>(options.far_distance);
  if (options.unbounded) return {near, far};
  const Eigen::Vector3f origin(&rays.origin[3 * r]), direction(&rays.direction[3 * r]);
  const float middle = -origin.dot(direction);
  // Computed from the point of the ray closest to the centre, so that distant cameras lose no
  // digits.
  const float closest = (origin + middle * direction).stableNorm();
  if (!(closest < 1)) return {near, near};
  const float half = std::sqrt((1 - closest) * (1 + closest));
  const float begin = std::clamp(middle - half, near, far);
  return {begin, std::clamp(middle + half, begin, far)};
}

void MarchRay(const RayBatch& rays, std::int64_t r, const OccupancyGrid& grid,
              const MarchOptions& options, RaySamples& out) {
  if (options.unbounded) return March<Contracted>(rays, r, grid, options, out);
  March<UnitBall>(rays, r, grid, options, out);
}

void MarchOptions::Check() const {
  if (near_distance < far_distance) return;
  throw InputError(
      "config: march.near_distance {} and march.far_distance {} must satisfy near < far",
      near_distance, far_distance);
}

bool UsesProposal(const MarchOptions& options, bool scene_has_alpha) {
  return options.sampler == SamplerKind::kAuto ? !scene_has_alpha
                                               : options.sampler == SamplerKind::kProposal;
}

PackedSamples MarchRays(const RayBatch& rays, const OccupancyGrid& grid,
                        const MarchOptions& options) {
  const std::int64_t count = rays.Size();
  // Chunks of fixed size, each with its own buffers, are concatenated in order, so that the result
  // does not depend on the number of threads.
  constexpr std::int64_t kChunk = 64;
  const std::int64_t chunks = (count + kChunk - 1) / kChunk;
  std::vector<RaySamples> parts(chunks);
  PackedSamples out;
  out.ray_begin.assign(count + 1, 0);
  ParallelFor(chunks, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t chunk = begin; chunk < end; ++chunk) {
      const std::int64_t last = std::min(count, (chunk + 1) * kChunk);
      for (std::int64_t r = chunk * kChunk; r < last; ++r) {
        const std::size_t before = parts[chunk].t.size();
        MarchRay(rays, r, grid, options, parts[chunk]);
        out.ray_begin[r + 1] = static_cast<std::int64_t>(parts[chunk].t.size() - before);
      }
    }
  });
  for (std::int64_t r = 0; r < count; ++r) out.ray_begin[r + 1] += out.ray_begin[r];

  const std::int64_t size = out.ray_begin[count];
  out.ray.resize(size);
  out.position.resize(3 * size);
  out.t.resize(size);
  out.dt.resize(size);
  ParallelFor(chunks, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t chunk = begin; chunk < end; ++chunk) {
      const std::int64_t first = chunk * kChunk, last = std::min(count, first + kChunk);
      const std::int64_t at = out.ray_begin[first];
      std::copy(parts[chunk].position.begin(), parts[chunk].position.end(),
                out.position.begin() + 3 * at);
      std::copy(parts[chunk].t.begin(), parts[chunk].t.end(), out.t.begin() + at);
      std::copy(parts[chunk].dt.begin(), parts[chunk].dt.end(), out.dt.begin() + at);
      for (std::int64_t r = first; r < last; ++r) {
        std::fill(out.ray.begin() + out.ray_begin[r], out.ray.begin() + out.ray_begin[r + 1], r);
      }
    }
  });
  return out;
}

}  // namespace nerf
