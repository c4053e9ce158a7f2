#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf::reference {

// A Gaussian as kernels/gaussians.h describes it, in double.
struct Gaussian {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d log_scale = Eigen::Vector3d::Zero();
  Eigen::Vector4d rotation{1, 0, 0, 0};  // w, x, y, z
  double opacity = 0;                    // before the sigmoid
  std::vector<Eigen::Vector3d> color;    // [1, 4, 9 or 16]
};

struct GaussianView {
  Camera camera;
  Eigen::Isometry3d camera_from_normalized = Eigen::Isometry3d::Identity();
  double near = 0.02;  // normalized units
};

struct GaussianPixel {
  Eigen::Vector3d rgb = Eigen::Vector3d::Zero();  // without background
  double transmittance = 1;
  double distance = 0;  // sum of weight times distance of the means
  // Distance of the one behind which less than half of the light is left; 0: more is left.
  double median_distance = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // sum of weight times normal
};

// What the camera sees of one Gaussian: mean and covariance in pixels, the latter with a pixel's
// footprint.
struct GaussianOnScreen {
  bool is_drawn = false;
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
  double opacity = 0;     // of the peak, with the share that the footprint leaves
  double peak_share = 1;  // opacity of the peak / opacity
  double distance = 0;
  Eigen::Vector3d rgb;
  Eigen::Vector3d normal;  // its shortest axis, towards the camera, normalized frame
};
GaussianOnScreen Project(const Gaussian& gaussian, const GaussianView& view);

// Every pixel of every Gaussian by the definition, without tiles, early end or vectors; the
// Jacobian of the lens is taken by central differences. Row after row.
std::vector<GaussianPixel> DrawGaussians(const std::vector<Gaussian>& gaussians,
                                         const GaussianView& view);

}  // namespace nerf::reference
