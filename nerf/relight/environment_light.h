#pragma once

#include <Eigen/Core>

#include "nerf/field/libtorch.h"
#include "nerf/light/environment_map.h"

namespace nerf {

// The axes of EnvironmentMap (y up, centre of the image -z) from those of a world in which z is up
// and the centre of a map is +x, as in Blender and in the NeRF-synthetic captures: a direction of
// azimuth a about z, counter-clockwise from +x, is at u = 1/2 - a / (2 pi).
Eigen::Matrix3d MapFromZUpWorld();

// The same from the axes of a frame that is turned against an input by `frame_from_input`, of which
// z is about up. If z of the input is up as well, within 20 degrees, the input's azimuth counts;
// otherwise, as in a reconstruction from photographs, that of the frame.
Eigen::Matrix3d MapFromFrame(const Eigen::Matrix3d& frame_from_input);

// MapFromFrame for a map that is turned about the vertical axis, counter-clockwise as seen from
// above.
Eigen::Matrix3d TurnedMap(const Eigen::Matrix3d& frame_from_input, double degrees);

// A map of 2 height x height pixels, in between the directions of a light.
//   radiance  [D,3] from LightDirections(D)
Image EnvironmentImage(const torch::Tensor& radiance, int height,
                       const Eigen::Matrix3d& map_from_directions);

// The radiance of a map from each of the directions: the mean over what is nearer to it than to the
// others, so that small lamps are not lost and the total power is kept.
//   directions          [D,3] float, unit, spread over the sphere
//   map_from_directions  rotation
//   returns             [D,3]
torch::Tensor RadianceFrom(const EnvironmentMap& map, const torch::Tensor& directions,
                           const Eigen::Matrix3d& map_from_directions);

}  // namespace nerf
