#pragma once

#include <memory>
#include <optional>

#include "nerf/effects/anti_aliasing.h"
#include "nerf/render/field_tile.h"
#include "nerf/render/packet_placement.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/render/render_quality.h"

namespace nerf {

// Renders like FusedRenderer, but faster where RenderQuality allows approximations: packets of
// neighbouring rays share sample distances, rays advance front to back a few samples at a time and
// stop once they are opaque, and radiance is evaluated for few of the samples.
//
// Every `quality.packet` successive rays of a batch are a packet (the order of RenderView). As in
// exact rendering, a pixel is a weighted mean of colours whose weights sum to the opacity: the
// approximations redistribute weight and never lose it.
class PacketRenderer : public RayRenderer {
 public:
  // `parts` must outlive it and must not change.
  PacketRenderer(const ModelParts& parts, const RenderQuality& quality);

  RenderOutput Render(const RayBatch& rays) const override;

 private:
  struct Tile;
  void Begin(const RayBatch& rays, std::int64_t first, std::int64_t last, Tile& tile) const;
  void RestartMissed(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Advance(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  static void GatherNext(Tile& tile);
  void Evaluate(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Accumulate(Tile& tile) const;
  void Shade(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void ShadeFaint(const RayBatch& rays, std::int64_t first, Tile& tile) const;

  RenderOutput RenderRays(const RayBatch& rays) const;
  void Finish(const RayBatch& rays, std::int64_t first, const Tile& tile, RenderOutput& out) const;

  const ModelParts& parts_;
  TileField field_;
  PacketPlacement placement_;
  RenderQuality quality_;
  BackgroundMap background_;  // if learned
};

}  // namespace nerf
