#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "nerf/base/options.h"
#include "nerf/geometry/rays.h"
#include "nerf/sampling/occupancy_grid.h"
#include "nerf/sampling/packed_samples.h"

namespace nerf {

// What places the samples of a ray.
enum class SamplerKind {
  kAuto,  // the grid for objects cut out by alpha, whose surroundings are empty, else a proposal
  kOccupancy,  // the occupancy grid
  kProposal,   // a proposal network
};
template <>
struct EnumNames<SamplerKind> {
  static constexpr std::pair<SamplerKind, std::string_view> kNames[] = {
      {SamplerKind::kAuto, "auto"},
      {SamplerKind::kOccupancy, "occupancy"},
      {SamplerKind::kProposal, "proposal"}};
};

struct MarchOptions {
  SamplerKind sampler = SamplerKind::kAuto;
  double near_distance = 0.05;
  double far_distance = 100.0;
  int steps_per_unit = 128;
  double stop_transmittance = 1e-4;
  // Whether there is anything outside the unit ball; set from effects.unbounded.
  bool unbounded = true;

  // What single ranges cannot say. Throws InputError.
  void Check() const;
  float StepLength() const { return 1.0f / static_cast<float>(steps_per_unit); }

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("sampler", o.sampler,
           "what places samples: the occupancy grid, a proposal network, or by alpha");
    option("near_distance", o.near_distance, "normalized units", Between(0, 1e8),
           "where rays begin");
    option("far_distance", o.far_distance, "normalized units", Between(0, 1e8), "where rays end");
    option("steps_per_unit", o.steps_per_unit, "steps", Between(1, 4096),
           "of the grid's march in a unit of contracted space");
    option("stop_transmittance", o.stop_transmittance, "", StrictlyBetween(0, 1),
           "a ray ends where less light than this gets through");
  }
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
