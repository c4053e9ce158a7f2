#pragma once

#include <memory>
#include <optional>

#include "nerf/effects/footprint.h"
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
  // Where there is a proposal (it may be null) it places the samples, else the grid does.
  PacketRenderer(std::shared_ptr<RadianceField> field, std::shared_ptr<OccupancyGrid> grid,
                 std::shared_ptr<ProposalField> proposal, const MarchOptions& march,
                 ProposalOptions proposal_options, const RenderQuality& quality,
                 kernels::Precision precision = kernels::Precision::kFloat,
                 const std::optional<FootprintOptions>& footprint = {});

  RenderOutput Render(const RayBatch& rays) override;

 private:
  struct Tile;
  void Begin(const RayBatch& rays, std::int64_t first, std::int64_t last, Tile& tile) const;
  void BeginMissed(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Shade(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Advance(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void Evaluate(const RayBatch& rays, std::int64_t first, Tile& tile) const;
  void ShadeFaint(const RayBatch& rays, std::int64_t first, Tile& tile) const;

  TileField field_;
  PacketPlacement placement_;
  MarchOptions march_;
  RenderQuality quality_;
  std::optional<FootprintOptions> footprint_;
};

}  // namespace nerf
