#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "nerf/effects/pose_refinement.h"
#include "nerf/field/libtorch.h"
#include "nerf/geometry/rays.h"

namespace nerf {

// Rays as their cameras stand after refinement.
struct RefinedRays {
  torch::Tensor origin, direction;  // [R,3]
};

// The rays of a batch at these origins and directions, in float. For the backward pass through
// `refined` call torch::autograd::backward with its two tensors.
RayBatch WithRefinedRays(const RayBatch& rays, const RefinedRays& refined);

// Poses and focal lengths that are a little wrong, refined together with the field: each photograph
// has a small rotation about its camera's centre and a shift, each lens a factor of its focal
// length. Source: Wang et al. 2021, "NeRF--"; Lin et al. 2021, "BARF", whose coarse-to-fine is the
// field's own (Annealing::detail).
//
// All cameras could move together and the field with them; so the part of their movements that is a
// similarity of the whole (seven degrees of freedom) is taken from them, by a projection. What is
// rendered from a known pose then stands where it stood.
//
// Positions of samples move with their ray; their distances along it, and the direction by which
// colour and background depend on the view, count as constants: a pose is to be told from where
// things stand, not from their gloss.
class PoseRefinement : public torch::nn::Module {
 public:
  // Starts with the poses as they are, which changes no bit.
  PoseRefinement(const std::vector<CameraPlace>& cameras, const PoseRefinementOptions& options);

  //   origin, direction  [R,3] as handed over, unit directions    photograph  [R] int64
  // Differentiable in the refinement. Rotations are exact to 1e-4 up to 80 degrees.
  RefinedRays forward(const torch::Tensor& origin, const torch::Tensor& direction,
                      const torch::Tensor& photograph);

  // Directions through lenses whose focal lengths are exp(log_f) times as long.
  //   direction, axis  [R,3] unit vectors    log_f  [R,1]
  static torch::Tensor Zoomed(const torch::Tensor& direction, const torch::Tensor& axis,
                              const torch::Tensor& log_f);

  // [photographs,6]: rotation vector about the camera's centre, radians, in normalized axes, and
  // shift, normalized units.
  torch::Tensor Twists() const;
  // [lenses] natural logarithm of the factor of each focal length.
  torch::Tensor LogFocals() const;

  // The pose of a photograph after refinement.
  Eigen::Isometry3d Refined(std::int64_t photograph,
                            const Eigen::Isometry3d& normalized_from_camera) const;

 private:
  double rate_;
  torch::Tensor twist_, log_focal_;  // parameters; what counts is these times the rate
  torch::Tensor similarities_;       // [6 photographs, <= 7] orthonormal
  torch::Tensor axis_, lens_;        // [photographs,3], [photographs]
};

// How far refinement went, for people to read: medians and most over the photographs.
struct PoseRefinementSummary {
  double median_degrees = 0, most_degrees = 0;
  double median_shift = 0, most_shift = 0;  // normalized units
  double most_focal = 0;                    // relative change of a focal length
};
PoseRefinementSummary Summarize(const PoseRefinement& poses);

}  // namespace nerf
