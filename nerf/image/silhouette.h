#pragma once

#include "nerf/image/image.h"

namespace nerf {

// The signed distance of each pixel's centre to the border between what is opaque (at least 1/2)
// and what is not, in pixels: negative in what is opaque. Infinite where there is no such border.
// Exact between pixel centres: Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled
// Functions".
//   opacity  1 channel
Image SilhouetteDistance(const Image& opacity);

}  // namespace nerf
