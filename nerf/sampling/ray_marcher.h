#pragma once

#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/rays.h"

namespace nerf {

struct MarchOptions {
  double near_distance = 0.05;       // first sample, in normalized scene units
  double far_distance = 100.0;       // last sample, in normalized scene units
  int steps_per_unit = 64;           // steps in a unit of contracted space
  double stop_transmittance = 1e-4;  // a ray ends where less light than this gets through

  void Check() const;
  float StepLength() const { return 1.0f / static_cast<float>(steps_per_unit); }
};

// Steps along each ray with a constant step in contracted space (so the step grows with the
// distance outside the unit ball as the field's resolution falls) and keeps the samples that stand
// in occupied cells, each in the middle of its step. The first step of a ray is shortened to the
// fraction 1 - jitter, which shifts all that follow.
PackedSamples MarchRays(const RayBatch& rays, const OccupancyGrid& grid,
                        const MarchOptions& options);

}  // namespace nerf
