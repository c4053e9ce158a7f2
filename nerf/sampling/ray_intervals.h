#pragma once

#include <cstdint>
#include <span>

#include "nerf/geometry/rays.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// The normalized distance s of a distance t, from 0 at the near plane to 1 at the far plane: linear
// in t up to distance 1 behind the near plane, linear in 1/t beyond. Source: Barron et al. 2022,
// equation 11, with the spacing of Tancik et al. 2023, "Nerfstudio".
float NormalizedDistance(float t, const MarchOptions& options);

// Divides ray r into intervals of equal length in contracted space, by quadrature along the ray, so
// that intervals are short where the field's resolution is fine.
//   edges  [N+1] written, ascending distances; edges[0] and edges[N] are the ends of RangeOfRay,
//          the inner ones are shifted by (the ray's jitter - 1/2) of an interval
void EqualIntervals(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                    std::span<float> edges);

// Resamples a ray so that each interval holds an equal share of a histogram's weight: evaluates the
// inverse of its cumulative distribution at regular values, shifted by one jitter per ray.
// Source: Mildenhall et al. 2020, section 5.2; Barron et al. 2022. The first and last edge are the
// ends of the ray, so that the intervals cover all of it: other implementations omit one part in
// M + 1, and lose the light of fog there.
//   edges    [N+1] ascending    weights  [N] >= 0, of any sum
//   padding  times 1 / N is added to each normalized weight, so that every part is still sampled
//   jitter   in [0,1), shifts the inner edges by (jitter - 1/2) of an interval
//   out      [M+1] written, ascending, from edges[0] to edges[N]
void ResampleIntervals(std::span<const float> edges, std::span<const float> weights, float padding,
                       float jitter, std::span<float> out);

// ResampleIntervals of the weights to the power of `exponent`, which is annealed from 0 (equal
// weight for each interval) to 1 as the proposal network learns. Source: Barron et al. 2022,
// "annealing".
void ResampleAnnealed(std::span<const float> edges, std::span<const float> weights, float exponent,
                      float padding, float jitter, std::span<float> out);

// Places one sample at the centre of each interval of a ray.
//   edges  [N+1]    position  [3N] contracted, in the unit cube    t, dt  [N]
void PackIntervalsOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options,
                        std::span<const float> edges, std::span<float> position, std::span<float> t,
                        std::span<float> dt);

}  // namespace nerf
