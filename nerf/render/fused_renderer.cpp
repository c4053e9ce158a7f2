#include "nerf/render/fused_renderer.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "nerf/base/parallel.h"
#include "nerf/field/background.h"
#include "nerf/render/background_rays.h"

namespace nerf {

FusedRenderer::FusedRenderer(const ModelParts& parts) : parts_(parts), forward_(parts) {
  forward_.Refresh(parts.annealing);
  if (parts.background) background_ = parts.background->Map();
}

RenderOutput FusedRenderer::Render(const RayBatch& rays) const {
  CheckRays(rays);
  return parts_.background ? RenderRays(WithBackground(rays, background_)) : RenderRays(rays);
}

RenderOutput FusedRenderer::RenderRays(const RayBatch& rays) const {
  const std::int64_t count = rays.Size();
  RenderOutput out;
  out.rgb.resize(3 * count);
  out.opacity.resize(count);
  out.depth.resize(count);
  const auto near = static_cast<float>(parts_.config.march.near_distance);
  const auto far = static_cast<float>(parts_.config.march.far_distance);
  std::atomic<std::int64_t> samples = 0;
  std::mutex adding;
  // Neighbouring rays share cells of the encoding; chunks are small enough to balance the threads.
  constexpr std::int64_t kChunk = 256;
  ParallelForEach((count + kChunk - 1) / kChunk, [&](std::int64_t chunk) {
    FusedTile tile;
    const std::int64_t last = std::min(count, (chunk + 1) * kChunk);
    for (std::int64_t first = chunk * kChunk; first < last;) {
      const std::int64_t next = forward_.Run(rays, first, last, tile);
      std::copy(tile.rgb.begin(), tile.rgb.end(), out.rgb.begin() + 3 * first);
      std::copy(tile.opacity.begin(), tile.opacity.end(), out.opacity.begin() + first);
      for (std::int64_t r = first; r < next; ++r) {
        const float opacity = tile.opacity[r - first], depth = tile.depth[r - first];
        out.depth[r] = opacity > 0 ? std::clamp(depth / opacity, near, far) : depth;
      }
      first = next;
    }
    samples += tile.placed;
    const std::lock_guard lock(adding);
    out.seconds.Add(tile.Seconds(), 1.0 / NumThreads());
  });
  out.samples = samples;
  return out;
}

}  // namespace nerf
