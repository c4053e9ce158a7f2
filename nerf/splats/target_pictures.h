#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "nerf/scene/view.h"
#include "nerf/splats/picture_loss.h"

namespace nerf {

// A photograph as Gaussians are fitted to it: with what the field has learned of its camera.
struct TargetView {
  const View* photograph = nullptr;          // its pixels; must outlive this
  Camera camera;                             // with a refined focal length
  Eigen::Isometry3d normalized_from_camera;  // refined
  std::array<float, 3> gains = {1, 1, 1};    // of its exposure, by which pixels are divided
  int halvings = 0;                          // of the resolution; that of the camera is reduced
};

// Photographs as they are.
std::vector<TargetView> TargetViewsOf(const std::vector<View>& views);

// The view at a resolution that is halved so many times more.
TargetView Reduced(TargetView view, int halvings);

// The photograph at the mean exposure. Pixels that it does not store have a weight of 0, clipped
// ones of a photograph that is brighter than the mean one of 0.1.
TargetPicture TargetOf(const TargetView& view);
// The same into a picture whose memory is used again. Uses all threads.
void MakeTarget(const TargetView& view, TargetPicture& target);

}  // namespace nerf
