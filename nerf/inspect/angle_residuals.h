#pragma once

#include <vector>

#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// How much the log light of a place without texture may vary between photographs.
inline constexpr double kTexturelessVariation = 0.05;

// The residuals of sightings in one range of angles, each between the direction to the camera and
// the mean direction to all cameras that observe the point.
struct AngleResiduals {
  double degrees = 0;  // the centre of the range
  int sightings = 0;
  double quartiles[3] = {};  // of |residual| relative to the variation that texture explains
};

// The residuals of a fit by viewing angle. They grow with the angle where surfaces are glossy and
// stay constant where they are only noise.
//   returns  ranges of 5 degrees, ascending: those with at least 30 sightings, of points with at
//            least 5 sightings
std::vector<AngleResiduals> ResidualsByAngle(const PosedImages& posed, const TrackColors& colors,
                                             const PhotographFit& fit);

}  // namespace nerf
