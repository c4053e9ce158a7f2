#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nerf/base/stopwatch.h"
#include "nerf/kernels/volume_rendering.h"
#include "nerf/render/field_tile.h"
#include "nerf/render/model_parts.h"
#include "nerf/render/proposal_tile.h"

namespace nerf {

// The state of a tile of rays between stages, and the intermediate results for the backward pass.
struct FusedTile {
  ProposalTile proposal;
  RaySamples samples;
  std::vector<std::int64_t> ray_begin;  // [R+1]
  std::vector<std::int64_t> ray;        // [S] index into the batch
  std::vector<std::int64_t> kept_of_ray, kept;
  FieldTile field;
  std::vector<float> rgb, opacity, depth;                // [R,3], [R], [R]
  std::int64_t placed = 0, shaded = 0;                   // samples, accumulated
  double sampling_seconds = 0, compositing_seconds = 0;  // accumulated

  StageSeconds Seconds() const {
    StageSeconds seconds = field.density.seconds;
    seconds.sampling = sampling_seconds;
    seconds.compositing = compositing_seconds;
    return seconds;
  }
  std::int64_t Rays() const { return static_cast<std::int64_t>(ray_begin.size()) - 1; }
  kernels::RaySegments<float> Segments(const RayBatch& rays, std::int64_t first) const {
    return {ray_begin,      field.density.sigma,
            samples.dt,     samples.t,
            field.radiance, std::span(rays.background).subspan(3 * first, 3 * Rays())};
  }
};

// The forward pass of a tile of rays, from their origins to their pixels.
class FusedForward {
 public:
  // `parts` must outlive it.
  explicit FusedForward(const ModelParts& parts);

  // Copies the networks' weights, which the optimiser changes between batches; hash tables are not
  // copied. Until the next Refresh, Run is safe from any thread.
  void Refresh(const Annealing& annealing);

  // Renders the rays from `first` on, as many as fill a tile. Returns the ray after the last.
  std::int64_t Run(const RayBatch& rays, std::int64_t first, std::int64_t last,
                   FusedTile& tile) const;

  TileField& Field() { return field_; }
  const TileField& Field() const { return field_; }
  std::optional<TileProposal>& Proposal() { return proposal_; }
  const std::optional<TileProposal>& Proposal() const { return proposal_; }

 private:
  std::int64_t PlaceSamples(const RayBatch& rays, std::int64_t first, std::int64_t last,
                            FusedTile& tile) const;
  void KeepVisible(FusedTile& tile) const;

  const ModelParts& parts_;
  TileField field_;
  std::optional<TileProposal> proposal_;
};

// Names the first ray of a tile with a non-finite value, and the stage that produced it.
//   target  [R,3] of the tile
//   first   index of the tile's first ray in the batch
std::string DescribeNonFinite(const FusedTile& tile, std::span<const float> target,
                              std::int64_t first);

}  // namespace nerf
