#include "nerf/render/background_rays.h"

#include <span>

#include "nerf/base/parallel.h"

namespace nerf {

RayBatch WithBackground(const RayBatch& rays, const BackgroundMap& map) {
  RayBatch out = rays;
  ParallelFor(rays.Size(), 256, [&](std::int64_t first, std::int64_t last) {
    const std::size_t begin = 3 * first, size = 3 * (last - first);
    map.Radiance(std::span(rays.direction).subspan(begin, size),
                 std::span(out.background).subspan(begin, size));
  });
  return out;
}

}  // namespace nerf
