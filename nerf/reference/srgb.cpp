#include "nerf/reference/srgb.h"

#include <cmath>

namespace nerf::reference {

long double SrgbFromLinear(long double linear) {
  if (linear < 0) return -SrgbFromLinear(-linear);
  if (linear <= 0.0031308L) return 12.92L * linear;
  return 1.055L * std::pow(linear, 1 / 2.4L) - 0.055L;
}

}  // namespace nerf::reference
