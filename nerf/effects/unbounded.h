#pragma once

namespace nerf {

// Matter beyond what the cameras look at, to any distance, in contracted space
// (nerf/sampling/contraction.h). Without it rays are cut to the unit ball about the scene, in which
// nothing is contracted (RangeOfRay in nerf/sampling/ray_marcher.h).
struct UnboundedOptions {};

}  // namespace nerf
