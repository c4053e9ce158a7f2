#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/packed_samples.h"

namespace nerf {

struct MarchOptions {
  // What places the samples: the "occupancy" grid or a "proposal" network. "auto" takes the grid
  // for photographs with alpha, whose objects have empty surroundings, and a proposal network
  // otherwise.
  std::string sampler = "auto";
  double near_distance = 0.05;       // near plane, normalized scene units
  double far_distance = 100.0;       // far plane, normalized scene units
  int steps_per_unit = 128;          // steps per unit of contracted space
  double stop_transmittance = 1e-4;  // early termination: transmittance at which a ray ends
  // Whether the scene extends beyond the unit ball; set from effects.unbounded.
  bool unbounded = true;

  void Check() const;
  bool IsUnbounded() const { return unbounded; }
  float StepLength() const { return 1.0f / static_cast<float>(steps_per_unit); }
};

// The samples of one ray, or of several rays one after the other.
struct RaySamples {
  std::vector<float> position;  // [S,3] contracted, in the unit cube
  std::vector<float> t, dt;     // [S] as in PackedSamples

  std::int64_t Size() const { return static_cast<std::int64_t>(t.size()); }
};

// The section of a ray on which samples are placed, near <= far.
struct RayRange {
  float near, far;
};
// The section of ray r between the near and the far plane; of a bounded scene, its intersection
// with the unit ball, in which the contraction is the identity. Empty where the ray misses the
// ball.
RayRange RangeOfRay(const RayBatch& rays, std::int64_t r, const MarchOptions& options);

// Whether a proposal network places the samples.
bool UsesProposal(const MarchOptions& options, bool scene_has_alpha);

// Marches along ray r with a constant step in contracted space (so that outside the unit ball steps
// grow as the field's resolution decreases), and appends to `out` one sample at the centre of each
// step that is in an occupied cell. The first step is shortened to the fraction 1 - jitter, which
// shifts all that follow.
void MarchRay(const RayBatch& rays, std::int64_t r, const OccupancyGrid& grid,
              const MarchOptions& options, RaySamples& out);

// MarchRay of all rays, on all threads.
PackedSamples MarchRays(const RayBatch& rays, const OccupancyGrid& grid,
                        const MarchOptions& options);

}  // namespace nerf
