#pragma once

#include <cstdint>
#include <vector>

#include "nerf/splats/initial_gaussians.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {

// Points of the visual hull of what photographs with alpha show: the voxels of the cube around the
// unit ball, normalized units, through which no photograph sees, although at least half look at
// them, and which border on some that are seen through. Their
// colours are means over the photographs that see them, or what is before them.
//   wanted  points; voxels are chosen so that there are about as many
//   returns empty where nothing is opaque in all photographs that see it
// Source: Laurentini 1994, "The visual hull concept for silhouette-based image understanding".
std::vector<ColoredPoint> VisualHull(const std::vector<TargetView>& views, std::int64_t wanted);

}  // namespace nerf
