#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The light at the pixel of a photograph at which a sparse point is observed, or should be.
struct Sighting {
  int point = 0;              // index into PosedImages::points
  int photograph = 0;         // index into PosedImages::images
  Eigen::Vector3f log_light;  // natural logarithm, linear RGB
  float contrast = 0;  // standard deviation of log light around the pixel: how much a pixel's
                       // displacement, or another slant, may change the light
};

struct TrackColors {
  std::vector<Sighting> seen;  // of the points' tracks
  // Where a point should be observed but is not: photographs from nearby do observe it, the nearest
  // one included, and this one observes no other point in that part. (An occluder that belongs to
  // the scene would have points of its own, or hide the point from the neighbour too.)
  std::vector<Sighting> unseen;
};

// Reads each photograph once, on all threads. Light is the mean over 5 x 5 pixels; pixels that are
// nearly black, clipped, transparent, masked or near the border are skipped, as are photographs
// that cannot be read.
//   nearby  the angle at a point, in radians, below which two photographs count as near each other
//   read    called with the number of photographs read so far, from any thread
TrackColors ReadTrackColors(const PosedImages& posed, double nearby,
                            const std::function<void(int)>& read = {});

// The angle at a point between the directions to two cameras, radians.
double AngleAt(const PosedImages& posed, int point, int photograph_a, int photograph_b);

}  // namespace nerf
