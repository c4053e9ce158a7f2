#pragma once

#include <Eigen/Core>

#include "nerf/image/image.h"

namespace nerf {

// Colour maps of values in [0,1] (clamped), as sRGB.
// From blue over green to red. Source: Mikhailov 2019, "Turbo", polynomial approximation.
Eigen::Vector3f Turbo(float value);
// From black over red and yellow to white, with increasing brightness.
Eigen::Vector3f Heat(float value);

// A depth map as a picture: from red (near) to blue (far), between the 2nd and 98th percentiles of
// the depths of mostly opaque pixels; transparent pixels fade to grey.
//   depth, opacity  [height, width, 1]; opacity in [0,1]; depth in any unit
//   returns         3 channels, sRGB
// Throws InputError if the sizes differ.
Image ColorizeDepth(const Image& depth, const Image& opacity);

// The difference of two pictures: Heat of the mean absolute difference of the sRGB values over a
// white background. kWhiteError is white in all pictures, so that they can be compared. Throws
// InputError if the sizes differ.
inline constexpr float kWhiteError = 0.25f;
Image ColorizeError(const Image& a, const Image& b);

}  // namespace nerf
