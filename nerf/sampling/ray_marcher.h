#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/packed_samples.h"

namespace nerf {

struct MarchOptions {
  // What places samples: the "occupancy" grid, a "proposal" field, or by "auto" the grid for
  // objects cut out by alpha, whose surroundings are empty, and a proposal for what has a
  // background.
  std::string sampler = "auto";
  double near_distance = 0.05;       // first sample, in normalized scene units
  double far_distance = 100.0;       // last sample, in normalized scene units
  int steps_per_unit = 128;          // steps in a unit of contracted space
  double stop_transmittance = 1e-4;  // a ray ends where less light than this gets through
  // What effects.unbounded says: whether there is anything outside the unit ball.
  bool unbounded = true;

  void Check() const;
  bool IsUnbounded() const { return unbounded; }
  float StepLength() const { return 1.0f / static_cast<float>(steps_per_unit); }
};

// The samples of one ray, or of several one after the other.
struct RaySamples {
  std::vector<float> position;  // [S,3] contracted, in the unit cube
  std::vector<float> t, dt;     // [S] as in PackedSamples

  std::int64_t Size() const { return static_cast<std::int64_t>(t.size()); }
};

// The part of a ray on which samples are placed, near <= far.
struct RayRange {
  float near, far;
};
// From near_distance to far_distance; where the scene is bounded, within the unit ball, in which
// the contraction is the identity. A ray that misses it has no length.
//   r  of the batch
RayRange RangeOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options);

// Whether a proposal field places the samples.
bool UsesProposal(const MarchOptions& options, bool scene_has_alpha);

// Steps along a ray with a constant step in contracted space (so the step grows with the
// distance outside the unit ball as the field's resolution falls) and keeps the samples that stand
// in occupied cells, each in the middle of its step. The first step of a ray is shortened to the
// fraction 1 - jitter, which shifts all that follow. Appends the samples of ray r to `out`.
void MarchRay(const RayBatch& rays, std::int64_t r, const OccupancyGrid& grid,
              const MarchOptions& options, RaySamples& out);

// MarchRay for all of them, on all threads.
PackedSamples MarchRays(const RayBatch& rays, const OccupancyGrid& grid,
                        const MarchOptions& options);

}  // namespace nerf
