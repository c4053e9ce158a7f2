#pragma once

#include "nerf/image/image.h"

namespace nerf {

// Depth from normals: the surface z(x, y) whose slopes are as near as possible to those of the
// normals, in the sense of least squares; orthographic.
//   for neighbours right and above:  z(x+1, y) - z(x, y) = -mean(n_x / n_z),
//                                    z(x, y-1) - z(x, y) = -mean(n_y / n_z)
// each weighted by the smaller n_z of the two, for what is nearly edge-on says little of its slope.
// Source: Horn and Brooks 1986 in its discrete form (Queau et al. 2018, section 2); solved by
// sparse Cholesky. Parts that do not touch have heights of their own, each of mean 0.
//   normal   3 channels, unit; x right, y up, z towards the camera; 0 0 0 outside the subject
//   returns  1 channel, linear: height towards the camera in pixels; NaN outside
// Throws InputError where more than kMostPixels are inside.
inline constexpr int kMostPixels = 1'500'000;
Image IntegrateNormals(const Image& normal);

}  // namespace nerf
