#pragma once

#include <vector>

#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Log light, by which places without any texture may change.
inline constexpr double kFlatChange = 0.05;

// What is left over of the light of points that are seen at about the same angle from where they
// are seen on average.
struct AngleResiduals {
  double degrees = 0;  // the middle of the angles
  int sightings = 0;
  double quartiles[3] = {};  // of what is left over, as a part of what texture explains
};

// Grows with the angle where surfaces are glossy; stays as it is where only noise is left over.
//   returns  by angle, 5 degrees each, only those with enough sightings; of points that are seen
//            often
std::vector<AngleResiduals> ResidualsByAngle(const PosedImages& posed, const TrackColors& colors,
                                             const PhotographFit& fit);

}  // namespace nerf
