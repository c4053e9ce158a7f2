#pragma once

#include <cstdint>
#include <span>

#include "nerf/geometry/rays.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// Where distance t stands between near and far, from 0 to 1: evenly up to distance 1 behind near,
// and evenly in 1/t beyond. Source: Tancik et al. 2023, "Nerfstudio".
float RayPlace(float t, const MarchOptions& options);

// Cuts ray r from near to far into intervals of equal length in contracted space, found by
// quadrature along the ray: where the field's resolution is fine, intervals are short.
//   edges  [N+1] written, rising distances; edges[0] and edges[N] are the ends of RangeOfRay; the
//          inner ones are shifted by the ray's jitter - 1/2 of an interval
void EqualIntervals(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                    std::span<float> edges);

// Cuts a ray anew so that each interval holds an equal share of the weight that a histogram gives:
// the inverse of its cumulative distribution at regular places, one jitter a ray. Source:
// Mildenhall et al. 2020, section 5.2; Barron et al. 2022. The first and the last edge are the
// ray's ends, so that no part of it is left out: what is (one interval in M + 1 elsewhere) is light
// that fog loses.
//   edges    [N+1] rising    weights  [N] >= 0, of any sum
//   padding  added to each weight's share of 1 / N, so that no place is given up for good
//   jitter   in [0,1), shifts the inner edges together by jitter - 1/2 of an interval
//   out      [M+1] written, rising, from edges[0] to edges[N]
void ResampleIntervals(std::span<const float> edges, std::span<const float> weights, float padding,
                       float jitter, std::span<float> out);

// The same for weights of a field that is trusted only in part: weights to the power of `trust`,
// so that 0 spreads the intervals evenly over those asked.
void CutByWeights(std::span<const float> edges, std::span<const float> weights, float trust,
                  float padding, float jitter, std::span<float> out);

// A ray's intervals as samples in their middles.
//   edges  [N+1]    position  [3N] contracted, in the unit cube    t, dt  [N]
void PackIntervalsOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                        std::span<const float> edges, std::span<float> position, std::span<float> t,
                        std::span<float> dt);

}  // namespace nerf
