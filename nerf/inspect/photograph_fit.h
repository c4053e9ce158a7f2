#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "nerf/inspect/track_colors.h"

namespace nerf {

// The colours of points over the photographs that see them, taken apart: log light = of the point +
// of the photograph + what is left over. A photograph's part is its exposure and white balance.
struct PhotographFit {
  std::vector<Eigen::Vector3f> of_point;
  std::vector<Eigen::Vector3f> of_photograph;  // their mean is 0
  std::vector<Eigen::Vector3f> left_over;      // of each sighting
};

// Fits the least sum of absolute values by reweighted means, of points and photographs in turn
// (Weiszfeld 1937; Huber 1981): what passes by, or glitters, in less than half of the sightings
// does not bend it.
PhotographFit FitPhotographs(std::span<const Sighting> sightings, std::size_t points,
                             std::size_t photographs);

}  // namespace nerf
