#pragma once

namespace nerf::reference {

// IEC 61966-2-1 on [0,1], for values of any sign and size as srgb.h extends it.
long double SrgbFromLinear(long double linear);

}  // namespace nerf::reference
