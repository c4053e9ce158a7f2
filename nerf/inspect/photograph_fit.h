#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "nerf/inspect/track_colors.h"

namespace nerf {

// A decomposition of the colours of points in the photographs that observe them:
//   log light = of_point + of_photograph + residual
// The part of a photograph is its exposure and white balance.
struct PhotographFit {
  std::vector<Eigen::Vector3f> of_point;
  std::vector<Eigen::Vector3f> of_photograph;  // their mean is 0
  std::vector<Eigen::Vector3f> residuals;      // of each sighting
};

// Minimizes the sum of absolute residuals by iteratively reweighted means, of points and
// photographs alternately (Weiszfeld 1937; Huber 1981). Passers-by and highlights in fewer than
// half of the sightings do not bias the fit.
PhotographFit FitPhotographs(std::span<const Sighting> sightings, std::size_t points,
                             std::size_t photographs);

}  // namespace nerf
