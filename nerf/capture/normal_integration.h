#pragma once

#include "nerf/image/image.h"

namespace nerf {

// Heights from normals: the surface z(x, y) with the slopes of the normals in the least-squares
// sense, in orthographic projection.
//   for the neighbours right and above:  z(x+1, y) - z(x, y) = -mean(n_x / n_z),
//                                        z(x, y-1) - z(x, y) = -mean(n_y / n_z)
// Each equation is weighted by the smaller n_z of the two pixels, because the slope of nearly
// edge-on surfaces is imprecise. Source: Horn and Brooks 1986, discretised as in Queau et al. 2018,
// section 2; solved by sparse Cholesky factorisation. Separate parts each have a mean height of 0.
//   normal   3 channels, unit; x right, y up, z towards the camera; 0 0 0 outside the subject
//   returns  1 channel, linear: height towards the camera in pixels; NaN outside
// Throws InputError if more than kMaxHeightPixels pixels have a normal.
inline constexpr int kMaxHeightPixels = 1'500'000;
Image IntegrateNormals(const Image& normal);

}  // namespace nerf
