#pragma once

#include <vector>

#include "nerf/sample/sample_options.h"
#include "nerf/sample/scene.h"
#include "sfm/posed_images.h"

namespace nerf::sample {

// What structure from motion would find in a sample's photographs, without finding it: points on
// surfaces, each with the photographs that see it, and pixels that are a third of a pixel wrong. No
// point of a passer-by, for no two photographs show the same one. Colours are left black.
std::vector<sfm::SparsePoint> SparsePoints(const Scene& scene, const sfm::PosedImages& posed,
                                           const SampleOptions& options);

}  // namespace nerf::sample
