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
  // What effects.unbounded says: whether there is anything outside the unit ball.
  bool unbounded = true;

  // What single ranges cannot say. Throws InputError.
  void Check() const;
  float StepLength() const { return 1.0f / static_cast<float>(steps_per_unit); }

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("sampler", o.sampler,
           "what places samples: the occupancy grid, a proposal network, or by alpha");
    option("near_distance", o.near_distance, "scene units", Between(0, 1e8), "where rays begin");
    option("far_distance", o.far_distance, "scene units", Between(0, 1e8), "and where they end");
    option("steps_per_unit", o.steps_per_unit, "steps", Between(1, 4096),
           "of the grid's march in a unit of contracted space");
    option("stop_transmittance", o.stop_transmittance, "", StrictlyBetween(0, 1),
           "a ray ends where less light than this gets through");
  }
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
