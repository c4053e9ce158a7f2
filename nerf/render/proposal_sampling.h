#pragma once

#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/field/proposal_field.h"
#include "nerf/geometry/rays.h"
#include "nerf/sampling/packed_samples.h"
#include "nerf/sampling/ray_intervals.h"

namespace nerf {

// The samples that a proposal network placed on a batch of rays, and the inputs of its loss.
struct ProposedSamples {
  PackedSamples samples;
  std::vector<float> edges;         // [R, samples + 1] distances
  std::vector<float> coarse_edges;  // [R, intervals + 1]
  torch::Tensor coarse_weights;     // [R * intervals], differentiable in the proposal's parameters
};

// Packed samples at the middles of intervals. Every ray has the same number of intervals.
//   edges  [R, intervals + 1] distances
PackedSamples PackIntervals(const RayBatch& rays, const MarchOptions& march,
                            const std::vector<float>& edges, std::int64_t intervals);

// Evaluates the proposal network at coarse samples, intervals of equal length in contracted space,
// and resamples each ray by its weights to the power of `exponent`. Source: Barron et al. 2022,
// "Mip-NeRF 360". The coarse weights are differentiable, the sample positions are not.
ProposedSamples ProposeSamples(const RayBatch& rays, ProposalField& proposal,
                               const ProposalOptions& options, const MarchOptions& march,
                               double exponent = 1);

// The mean over rays of the interlevel loss and of the distortion loss, each multiplied by its
// weight in the options.
//   visible  the samples that were evaluated: the first ones of each ray's proposed samples
//   sigma    [S] of the visible samples
// Differentiable in the proposal's parameters and, through the distortion loss, in sigma.
torch::Tensor ProposalLoss(const ProposedSamples& proposed, const PackedSamples& visible,
                           const torch::Tensor& sigma, const ProposalOptions& options,
                           const MarchOptions& march);

}  // namespace nerf
