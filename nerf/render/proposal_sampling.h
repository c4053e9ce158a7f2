#pragma once

#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/field/proposal_field.h"
#include "nerf/geometry/rays.h"
#include "nerf/sampling/packed_samples.h"
#include "nerf/sampling/ray_intervals.h"

namespace nerf {

// The samples of a batch of rays that a proposal field chose, and what its loss needs.
struct ProposedSamples {
  PackedSamples samples;
  std::vector<float> edges;         // [R, samples + 1] distances
  std::vector<float> coarse_edges;  // [R, intervals + 1]
  torch::Tensor coarse_weights;     // [R * intervals], differentiable in the proposal's parameters
};

// Intervals as packed samples in their middles. Every ray has the same number of intervals.
//   edges  [R, intervals + 1]
PackedSamples PackIntervals(const RayBatch& rays, const MarchOptions& march,
                            const std::vector<float>& edges, std::int64_t intervals);

// Asks the proposal at intervals of equal length in contracted space, and cuts each ray anew by its
// weights to the power of `exponent`. The places of the samples carry no gradient.
ProposedSamples ProposeSamples(const RayBatch& rays, ProposalField& proposal,
                               const ProposalOptions& options, const MarchOptions& march,
                               double exponent = 1);

// Mean over rays of the proposal's loss and of the distortion, each times its weight in the
// options.
//   visible  the samples that were evaluated, the front of each ray's proposed ones
//   sigma    [S] of the visible samples
// Differentiable in the proposal's parameters and, for the distortion, in sigma.
torch::Tensor ProposalLoss(const ProposedSamples& proposed, const PackedSamples& visible,
                           const torch::Tensor& sigma, const ProposalOptions& options,
                           const MarchOptions& march);

}  // namespace nerf
