#pragma once

#include <Eigen/Core>

namespace nerf {

// Linear RGB with the primaries and the white of sRGB: radiance, irradiance, or reflectance, which
// multiply channel by channel. sRGB's transfer function is met at the edge only (nerf/data).
using Color = Eigen::Array3d;

// Relative luminance, Y of CIE 1931. Source: IEC 61966-2-1.
inline double Luminance(const Color& color) {
  return 0.2126 * color.x() + 0.7152 * color.y() + 0.0722 * color.z();
}

}  // namespace nerf
