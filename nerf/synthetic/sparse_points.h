#pragma once

#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/sample_options.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {

// Simulates the sparse points of structure from motion: points on surfaces, each with a track of
// the photographs that see it, at pixels with an error of a third of a pixel (standard deviation).
// Passers-by have no points, as each is in one photograph only. Colours are black.
std::vector<SparsePoint> SparsePoints(const Scene& scene, const PosedImages& posed,
                                      const SampleOptions& options);

}  // namespace nerf::synthetic
