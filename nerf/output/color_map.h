#pragma once

#include <Eigen/Core>

#include "nerf/image/image.h"

namespace nerf {

// Colours for numbers in [0,1] (clamped), as sRGB.
// Blue over green to red. Source: Mikhailov 2019, "Turbo", polynomial approximation.
Eigen::Vector3f Turbo(float value);
// Black over red and yellow to white: brightness grows with the value.
Eigen::Vector3f Heat(float value);

// A depth map to look at: near is red, far is blue, between the 2nd and 98th percentiles of the
// depths of pixels that are mostly opaque; what is not opaque fades to grey.
//   depth, opacity  [height, width, 1]; opacity in [0,1]; depth in any unit
//   returns         3 channels, sRGB
// Throws InputError where the two differ in size.
Image ColorizeDepth(const Image& depth, const Image& opacity);

// How far two pictures differ: Heat of the mean absolute difference of the sRGB values over white,
// with white at kWhiteError, the same for all pictures so that they can be compared.
// Throws InputError where the two differ in size.
inline constexpr float kWhiteError = 0.25f;
Image ColorizeError(const Image& a, const Image& b);

}  // namespace nerf
