#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/effects/pose_refinement.h"
#include "nerf/field/libtorch.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// Rays of the refined cameras.
struct RefinedRays {
  torch::Tensor origin, direction;  // [R,3]
};

// The rays of a batch with the refined origins and directions, in float and detached. For the
// backward pass through `refined` call torch::autograd::backward with its two tensors.
RayBatch WithRefinedRays(const RayBatch& rays, const RefinedRays& refined);

// Poses and focal lengths that are slightly wrong, refined jointly with the field: a small rotation
// about the camera centre and a translation per photograph, a factor of the focal length per lens.
// Source: Wang et al. 2021, "NeRF--"; Lin et al. 2021, "BARF", whose coarse-to-fine schedule is
// here that of the field (Annealing::detail).
//
// The joint movement of all cameras that is a similarity of the whole scene (seven degrees of
// freedom) is unobservable and is projected out, so that the scene stays in its frame.
//
// Sample positions move with their ray. Distances along the ray, and the direction as an input of
// the colour network and the background, are constants in the backward pass: a pose is determined
// by geometry, not by view-dependent colour.
class PoseRefinement : public torch::nn::Module {
 public:
  // Starts from the given poses; without refinement no bit of a ray changes.
  PoseRefinement(const std::vector<CameraPlace>& cameras, const PoseRefinementOptions& options);

  //   origin, direction  [R,3] by the given poses, unit directions    photograph  [R] int64
  // Differentiable in the refinement. Rotations are exact to 1e-4 up to 80 degrees. Throws
  // c10::Error on a shape mismatch.
  RefinedRays forward(const torch::Tensor& origin, const torch::Tensor& direction,
                      const torch::Tensor& photograph);

  // The directions of the same pixels through lenses with exp(log_f) times the focal length.
  //   direction, axis  [R,3] unit vectors    log_f  [R,1]
  // Differentiable.
  static torch::Tensor ScaleFocalLength(const torch::Tensor& direction, const torch::Tensor& axis,
                                        const torch::Tensor& log_f);

  // [photographs,6]: rotation vector about the camera centre, radians, in normalized axes, and
  // translation, normalized units.
  torch::Tensor Twists() const;
  // [lenses] natural logarithm of the factor of each focal length.
  torch::Tensor LogFocals() const;

  // The refined pose of a photograph.
  Eigen::Isometry3d Refined(std::int64_t photograph,
                            const Eigen::Isometry3d& normalized_from_camera) const;

 private:
  double rate_;
  torch::Tensor twist_, log_focal_;  // parameters, in units of the rate
  torch::Tensor similarities_;       // [6 * photographs, <= 7] orthonormal
  torch::Tensor axis_, lens_;        // [photographs,3], [photographs]
};

// The size of the refinement: median and maximum over the photographs.
struct PoseRefinementSummary {
  double median_degrees = 0, max_degrees = 0;
  double median_shift = 0, max_shift = 0;  // normalized units
  double max_focal = 0;                    // relative change of a focal length
};
PoseRefinementSummary Summarize(const PoseRefinement& poses);

}  // namespace nerf
