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

// The rays of a tile as the proposal saw them, and what the way back needs.
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

  // Cuts rays [first, last) into options.samples intervals each: tile.edges.
  void Cut(const RayBatch& rays, std::int64_t first, std::int64_t last, ProposalTile& tile) const;

  // The same, with the samples in the middle of the intervals.
  void Propose(const RayBatch& rays, std::int64_t first, std::int64_t last, ProposalTile& tile,
               RaySamples& samples) const;

  // The gradients of the proposal's loss and of the distortion, each ray's divided by `rays`.
  //   ray_begin, sigma, dt  the visible samples, the front of each ray's proposed ones
  //   dL_dsigma             [S] the distortion's part is added to it
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
