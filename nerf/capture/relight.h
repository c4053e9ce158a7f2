#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "nerf/capture/light_voronoi.h"
#include "nerf/capture/olat_capture.h"
#include "nerf/image/image.h"
#include "nerf/light/environment_map.h"

namespace nerf {

// The weights with which the images of a capture sum to the subject under an environment:
// L(x, y) = sum over lights of R_xy(light) L_i dA, where R = image / irradiance is the reflectance
// field and L_i dA the integral of the radiance over the cell of the light (light_voronoi.h).
// Source: Debevec et al. 2000, "Acquiring the Reflectance Field of a Human Face", eq. 1.
//   degrees  rotation of the environment about y, counter-clockwise as seen from above
std::vector<Color> RelightWeights(const OlatCapture& capture, const LightVoronoi& cells,
                                  const EnvironmentMap& map, double degrees);

// Sums the images of a capture with each set of weights, in linear light, channel by channel. Each
// image is read once for as many sets as fit into memory; only those sums and one image are held.
//   weights  [sets][images]
//   memory   bytes for pixels; at least two images are held
//   keep_on  called before each image; false ends the work
//   consume  called with the index of a set and its picture, linear, 3 channels, in order
//   returns  false if keep_on ended the work
// Throws InputError naming an image that cannot be read or has another size.
bool Relight(const OlatCapture& capture, InputEncoding encoding,
             const std::vector<std::vector<Color>>& weights, std::int64_t memory,
             const std::function<bool()>& keep_on,
             const std::function<void(int, const Image&)>& consume);

// Throws InputError if all images of a capture are black. Reads them up to the first that is not.
void CheckNotBlack(const OlatCapture& capture, InputEncoding encoding);

// The exposure in stops with which 98 % of the pixels of a linear picture are below 0.8; 0 for a
// black picture.
double AutoExposure(const Image& picture);

// A picture multiplied by 2^stops.
Image WithExposure(Image picture, double stops);

}  // namespace nerf
