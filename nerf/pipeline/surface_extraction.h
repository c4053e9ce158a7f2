#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "nerf/geometry/mesh.h"
#include "nerf/geometry/scalar_grid.h"
#include "nerf/model/scene_model.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {

struct SurfaceExtractionOptions {
  int resolution = 160;   // cells along the longest side of what is opaque
  double truncation = 4;  // cells, see FusionBox
  double blur = 1;        // cells: what is finer than this is noise of the depth
};

// The surface of a model, in the normalized frame.
struct ExtractedSurface {
  ScalarGrid distance;  // signed, in units of the truncation; its gradient points outwards
  Mesh mesh;            // SurfaceMesh of it
};

// The surface on which the depths agree that a model renders at the poses of photographs, within
// the unit ball (FuseDepth).
//   progress  called with the number of views done
//   returns   nullopt where it was stopped
// Throws InputError where nothing is opaque within the unit ball.
std::optional<ExtractedSurface> ExtractSurface(const SceneModel& model,
                                               const std::vector<TargetView>& views,
                                               const SurfaceExtractionOptions& options,
                                               const std::atomic<bool>& stop,
                                               const std::function<void(std::size_t)>& progress);

}  // namespace nerf
