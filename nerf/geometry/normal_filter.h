#pragma once

#include "nerf/geometry/mesh.h"

namespace nerf {

struct NormalFilterOptions {
  int iterations = 10;
  double angle = 20;  // degrees: normals that differ by more hardly count
};

// Smooths the normals of vertices, but not across edges: each becomes the mean of those that share
// an edge with it, and of itself, weighted by exp(-(difference / angle)^2), as often as there are
// iterations. An invalid normal stays so, and counts nothing.
// Source: Zheng et al. 2011, "Bilateral Normal Filtering for Mesh Denoising", for vertices of even
// spacing.
void FilterNormals(Mesh& mesh, const NormalFilterOptions& options);

}  // namespace nerf
