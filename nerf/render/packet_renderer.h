#pragma once

#include <memory>
#include <optional>

#include "nerf/effects/anti_aliasing.h"
#include "nerf/render/field_tile.h"
#include "nerf/render/packet_placement.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/render/render_quality.h"

namespace nerf {

// Renders what FusedEngine renders, with less work where RenderQuality allows it: neighbouring rays
// share where their samples stand, rays are followed front to back a few samples at a time and
// leave the tile where no light gets through, and only samples that count are given a colour.
//
// Every `quality.packet` rays of a batch, in order, are taken for neighbours (as RenderView sends
// them). The result is a weighted mean of colours whose weights sum to the opacity, as the exact
// one is: what is left out moves weight, and never loses it.
class PacketRenderer : public RayRenderer {
 public:
  // `parts` must outlive it, and not change.
  PacketRenderer(const ModelParts& parts, const RenderQuality& quality);

  RenderOutput Render(const RayBatch& rays) const override;

 private:
  struct Tile;
  void Begin(const RayBatch& rays, std::int64_t first, std::int64_t last, Tile& tile) const;
  void BeginMissed(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Shade(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Advance(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Evaluate(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void ShadeFaint(const RayBatch& rays, std::int64_t first, Tile& tile) const;

  RenderOutput RenderRays(const RayBatch& rays) const;
  void Finish(const RayBatch& rays, std::int64_t first, const Tile& tile, RenderOutput& out) const;

  const ModelParts& parts_;
  TileField field_;
  PacketPlacement placement_;
  RenderQuality quality_;
  BackgroundMap background_;  // where it is learned
};

}  // namespace nerf
