#include "nerf/sampling/packed_samples.h"

#include <algorithm>

namespace nerf {

PackedSamples KeepFront(const PackedSamples& samples, const std::vector<std::int64_t>& kept) {
  PackedSamples out;
  const std::int64_t rays = samples.Rays();
  out.ray_begin.resize(rays + 1);
  out.ray_begin[0] = 0;
  for (std::int64_t r = 0; r < rays; ++r) out.ray_begin[r + 1] = out.ray_begin[r] + kept[r];
  const std::int64_t size = out.ray_begin[rays];
  out.ray.resize(size);
  out.position.resize(3 * size);
  out.t.resize(size);
  out.dt.resize(size);
  for (std::int64_t r = 0; r < rays; ++r) {
    const std::int64_t from = samples.ray_begin[r], to = out.ray_begin[r], count = kept[r];
    std::copy_n(samples.ray.begin() + from, count, out.ray.begin() + to);
    std::copy_n(samples.position.begin() + 3 * from, 3 * count, out.position.begin() + 3 * to);
    std::copy_n(samples.t.begin() + from, count, out.t.begin() + to);
    std::copy_n(samples.dt.begin() + from, count, out.dt.begin() + to);
  }
  return out;
}

}  // namespace nerf
