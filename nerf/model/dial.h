#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/model/model.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A position of the dial of rendering, and what it costs and loses in a view.
struct DialPosition {
  double quality = 1;
  double seconds = 0;  // a frame
  double psnr = 0;  // dB, against the exact picture of the same view; infinite where they are equal
};

// Finds out on strips of a view, about an eighth of it, what positions of the dial take and what
// they change against the exact picture.
class Dial {
 public:
  // `model` must outlive it. Renders the strips exactly.
  Dial(const Model& model, const Camera& camera, const Eigen::Isometry3d& normalized_from_camera);

  // Throws InputError where quality is not in [0, 1].
  DialPosition Measure(double quality) const;

  // The best position at which a frame takes at most `seconds`, found by halving; the fast end
  // where none does.
  DialPosition Choose(double seconds) const;

 private:
  Image Render(double quality, double& seconds) const;

  const Model& model_;
  std::vector<Camera> strips_;
  Eigen::Isometry3d normalized_from_camera_;
  double strips_in_a_frame_ = 1;
  Image exact_;
  double exact_seconds_ = 0;
};

}  // namespace nerf
