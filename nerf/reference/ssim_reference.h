#pragma once

#include "nerf/image/image.h"

namespace nerf::reference {

// Wang et al. 2004 as it is written: for every window its 121 weights, means and covariances, the
// latter around the mean. Takes the pixels as they are: no rounding, no alpha.
double Ssim(const Image& a, const Image& b);

}  // namespace nerf::reference
