#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "nerf/capture/light_voronoi.h"
#include "nerf/capture/olat_capture.h"
#include "nerf/image/image.h"
#include "nerf/light/environment_map.h"

namespace nerf {

// What a capture's images must be multiplied with and summed to show its subject under an
// environment: L(x, y) = sum over lights of R_xy(light) L_i dA, where R = image / irradiance is the
// reflectance field and L_i dA the environment's radiance over the light's patch (light_voronoi.h).
// Source: Debevec et al. 2000, "Acquiring the Reflectance Field of a Human Face", eq. 1.
//   degrees  turns the environment about y, counter-clockwise seen from above
std::vector<Color> RelightWeights(const OlatCapture& capture, const LightVoronoi& cells,
                                  const EnvironmentMap& map, double degrees);

// Sums a capture's images with each set of weights, in linear light, channel by channel. Reads each
// image once for as many sets as fit into the memory, so a thousand lights of 12 megapixels need
// no more than a few images' worth.
//   weights  [sets][images]
//   memory   bytes for pixels; at least two images are held
//   keep_on  asked before each image; false ends the work (returns false then)
//   consume  called with the index of a set and its picture, linear, 3 channels, in order
// Throws InputError naming an image that cannot be read or has another size.
bool Relight(const OlatCapture& capture, InputEncoding encoding,
             const std::vector<std::vector<Color>>& weights, std::int64_t memory,
             const std::function<bool()>& keep_on,
             const std::function<void(int, const Image&)>& consume);

// Throws InputError where all images of a capture are black. Reads them up to the first that
// is not.
void RefuseBlackCapture(const OlatCapture& capture, InputEncoding encoding);

// The stops by which a linear picture must be made brighter for 98 % of its pixels to be below 0.8;
// 0 for a black one.
double AutoExposure(const Image& picture);

// A picture made brighter by so many stops: times 2^stops.
Image Exposed(Image picture, double stops);

}  // namespace nerf
