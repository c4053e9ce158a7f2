#pragma once

namespace nerf::reference {

// IEC 61966-2-1, extended beyond [0,1] as in nerf/image/srgb.h.
long double SrgbFromLinear(long double linear);

}  // namespace nerf::reference
