#pragma once

#include "nerf/image/image.h"

namespace nerf::reference {

// Wang et al. 2004: for each window the means and the covariances around them, from its 121
// weights. Neither rounds pixels nor handles alpha.
double Ssim(const Image& a, const Image& b);

}  // namespace nerf::reference
