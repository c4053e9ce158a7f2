#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "nerf/render/model_parts.h"
#include "nerf/render/proposal_tile.h"
#include "nerf/render/render_quality.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// Where the samples of a tile of rays stand, for PacketRenderer.
struct PlacedTile {
  struct Range {
    std::int64_t begin = 0, end = 0;
  };
  RaySamples samples;
  std::vector<Range> of_ray;  // [R] of the samples

  // Room to work in.
  RayBatch asked;
  ProposalTile proposal;
};

// Places the samples of neighbouring rays: by the grid each ray for itself, by a proposal where the
// ray through the middle of their packet finds matter.
class PacketPlacement {
 public:
  // `parts` must outlive it, and not change.
  PacketPlacement(const ModelParts& parts, const RenderQuality& quality);

  // Rays [first, last) of a batch, every quality.packet of them, in order, neighbours.
  void Place(const RayBatch& rays, std::int64_t first, std::int64_t last, PlacedTile& tile) const;

  // Whether rays share the places of their packet, and may have missed what they meet.
  bool Shared() const { return proposal_ && packet_ > 1; }

  // Rays of the tile, by their place in it, anew and each by itself.
  void PlaceAlone(const RayBatch& rays, std::int64_t first, std::span<const std::int64_t> missed,
                  PlacedTile& tile) const;

 private:
  void PackRay(const RayBatch& rays, std::int64_t r, std::int64_t asked, std::int64_t k,
               PlacedTile& tile) const;

  const OccupancyGrid& grid_;
  std::optional<TileProposal> proposal_;
  const MarchOptions& march_;
  std::int64_t packet_, samples_;
};

}  // namespace nerf
