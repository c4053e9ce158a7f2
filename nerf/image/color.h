#pragma once

#include <Eigen/Core>

namespace nerf {

// Linear RGB with the primaries and the white point of sRGB: radiance, irradiance or reflectance.
// An array, so that products are channel by channel. The transfer function of sRGB is applied only
// where images are read and written (nerf/image/srgb.h).
using Color = Eigen::Array3d;

// Relative luminance: Y of CIE 1931. Source: IEC 61966-2-1.
inline double Luminance(const Color& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

}  // namespace nerf
