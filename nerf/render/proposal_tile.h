#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "nerf/field/proposal_field.h"
#include "nerf/geometry/rays.h"
#include "nerf/render/density_tile.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// The coarse samples and the resampled intervals of a tile of rays, and the intermediate results
// for the backward pass.
struct ProposalTile {
  std::vector<float> edges;             // [R, samples + 1]
  std::vector<float> coarse_edges;      // [R, intervals + 1]
  std::vector<float> position, t, dt;   // of the coarse samples
  std::vector<std::int64_t> ray_begin;  // [R+1] of the coarse samples
  std::vector<float> weights, dL_dweights, dL_dsigma, places;
  DensityTile density;
};

// ProposeSamples and ProposalLoss (proposal_sampling.h) for tiles of rays.
class TileProposal {
 public:
  // The network must outlive it.
  TileProposal(const ProposalField& proposal, const ProposalOptions& options,
               const MarchOptions& march);

  // Copies the network's weights, which the optimiser changes between batches.
  //   exponent  of the proposal's weights, in [0,1]
  void Refresh(double exponent);

  // Resamples rays [first, last) into options.samples intervals each: tile.edges.
  void Resample(const RayBatch& rays, std::int64_t first, std::int64_t last,
                ProposalTile& tile) const;

  // The same, and places samples at the middles of the intervals.
  void Propose(const RayBatch& rays, std::int64_t first, std::int64_t last, ProposalTile& tile,
               RaySamples& samples) const;

  // The backward pass of ProposalLoss.
  //   rays                  of the whole batch, over which the loss is a mean
  //   ray_begin, sigma, dt  the visible samples: the first ones of each ray's proposed samples
  //   dL_dsigma             [S] the gradient of the distortion loss is added
  void Backward(std::int64_t rays, std::span<const std::int64_t> ray_begin,
                std::span<const float> sigma, std::span<const float> dt, ProposalTile& tile,
                std::span<float> dL_dsigma, DensityGradients& gradients) const;

  void Clear(DensityGradients& gradients) const { density_.Clear(gradients); }
  void AddToParameters(std::span<const DensityGradients* const> gradients) {
    density_.AddToParameters(gradients);
  }
  int SamplesPerRay() const { return options_.samples; }
  int IntervalsPerRay() const { return options_.intervals; }

 private:
  const ProposalField& proposal_;
  float exponent_ = 1;
  ProposalOptions options_;
  MarchOptions march_;
  TileDensity density_;
};

}  // namespace nerf
