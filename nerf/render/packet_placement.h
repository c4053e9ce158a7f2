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

// The samples of a tile of rays, for PacketRenderer.
struct PlacedTile {
  struct Range {
    std::int64_t begin = 0, end = 0;
  };
  RaySamples samples;
  std::vector<Range> of_ray;  // [R] each ray's range of the samples

  // Scratch memory.
  RayBatch proposal_rays;
  ProposalTile proposal;
};

// Places the samples of rays: by the occupancy grid for each ray, by the proposal network for the
// mean ray of a packet of neighbours, which share its distances.
class PacketPlacement {
 public:
  // `parts` must outlive it and must not change.
  PacketPlacement(const ModelParts& parts, const RenderQuality& quality);

  // Places the samples of rays [first, last) of a batch; every quality.packet successive rays are a
  // packet of neighbours.
  void Place(const RayBatch& rays, std::int64_t first, std::int64_t last, PlacedTile& tile) const;

  // Whether the rays of a packet share distances, which can miss a surface that one of them hits.
  bool SharesSamples() const { return proposal_ && packet_ > 1; }

  // Places the samples of some rays of the tile again, each ray by itself.
  //   missed  indices into the tile
  void PlaceIndividually(const RayBatch& rays, std::int64_t first,
                         std::span<const std::int64_t> missed, PlacedTile& tile) const;

 private:
  void PackRay(const RayBatch& rays, std::int64_t r, std::int64_t from, std::int64_t k,
               PlacedTile& tile) const;

  const OccupancyGrid& grid_;
  std::optional<TileProposal> proposal_;
  const MarchOptions& march_;
  std::int64_t packet_, samples_;
};

}  // namespace nerf
