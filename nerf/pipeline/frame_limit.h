#pragma once

#include <vector>

#include "nerf/splats/gaussian_fit.h"
#include "nerf/splats/target_pictures.h"

namespace nerf {

// Seconds that a picture of one of the views takes on this machine now: the median over some.
double SecondsPerFrame(const GaussianCloud& cloud, const std::vector<TargetView>& views,
                       double near);

// Where a fit has more Gaussians than can be drawn in time, leaves out those that show least, as
// many as the time for a frame suggests. As what is left grows into their place, a fit calls this
// several times.
//   seconds  for a frame
void KeepToFrameTime(GaussianFit& fit, const std::vector<TargetView>& views, double near,
                     double seconds);

}  // namespace nerf
