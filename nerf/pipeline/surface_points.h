#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "nerf/model/scene_model.h"
#include "nerf/splats/initial_gaussians.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {

struct SurfacePoints {
  std::vector<ColoredPoint> points;
  double nearest = 0;  // of what views see, normalized units: the least of their 2 % quantiles
};

// Points of the surfaces of a model: the depth that it renders at the poses of photographs, where
// at least two other views see the same surface; then one point in each voxel of contracted space,
// of a size that leaves about as many as wanted. Where photographs without alpha see no surface,
// there are points far away instead: a sky. Empty where the views agree on no surface.
//   views     poses and cameras; rendered at a resolution that gives several pixels for each point
//   progress  called with the number of views done
//   returns   nullopt where it was stopped
std::optional<SurfacePoints> FindSurfacePoints(const SceneModel& model,
                                               const std::vector<TargetView>& views,
                                               std::int64_t wanted, const std::atomic<bool>& stop,
                                               const std::function<void(std::size_t)>& progress);

}  // namespace nerf
