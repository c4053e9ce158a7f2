#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// The light that a photograph shows where it sees, or should see, a sparse point.
struct Sighting {
  int point = 0;              // index into PosedImages::points
  int photograph = 0;         // index into PosedImages::images
  Eigen::Vector3f log_light;  // natural logarithm, linear RGB
  float contrast = 0;         // standard deviation of log light about the place: what an error of a
                              // pixel or another slant may change
};

struct TrackColors {
  std::vector<Sighting> seen;    // of the points' tracks
  std::vector<Sighting> unseen;  // where no track says so though photographs from nearby see the
                                 // point, the nearest among them, in a part of the photograph
                                 // without any known point: what is of the scene and stands before
                                 // it has points of its own, or stands before the neighbour's, too
};

// Reads each photograph once, on all threads. Light is the mean over a few pixels; places that are
// black, white to the end of their scale, transparent or at the border are left out.
//   nearby  radians at the point, between two photographs from nearby
//   read    called with the number of photographs read
TrackColors ReadTrackColors(const PosedImages& posed, double nearby,
                            const std::function<void(int)>& read = {});

// The angle at a point between two cameras, radians.
double AngleAt(const PosedImages& posed, int point, int photograph_a, int photograph_b);

}  // namespace nerf
