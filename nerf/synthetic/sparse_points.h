#pragma once

#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/sample_options.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// What structure from motion would find in a sample's photographs, without finding it: points on
// surfaces, each with the photographs that see it, and pixels that are a third of a pixel wrong. No
// point of a passer-by, for no two photographs show the same one. Colours are left black.
std::vector<SparsePoint> SparsePoints(const Scene& scene, const PosedImages& posed,
                                      const SampleOptions& options);

}  // namespace nerf::synthetic
