#pragma once

#include <cstdint>
#include <span>

#include "nerf/kernels/gaussians.h"

namespace nerf::kernels {

// Projects Gaussians: the mean through the lens, the covariance through the Jacobian J of the lens
// at the mean (EWA), to which the footprint of a pixel is added:
//   Sigma = J R S S^T R^T J^T,  Sigma' = Sigma + kPixelVariance I
//   opacity' = opacity sqrt(det Sigma / det Sigma')
// so that the sum of alpha over the pixels does not change with distance: what is smaller than a
// pixel covers its share of it. det Sigma is computed as the square of a cross product, so that it
// is not a difference of large numbers. log_scale is bounded to [-20, 8].
// Source: Zwicker et al. 2001, "EWA Volume Splatting"; Yu et al. 2024, "Mip-Splatting".
//
// Writes those that are visible, in the order of their index: not nearer than camera.near, opacity
// of at least kLeastAlpha, and a pixel centre of the image in what is not cut. first_slot and tiles
// are left open.
//   parameters  [blocks][GaussianRows(order)][16]
//   out         room for all Gaussians of the blocks [first_block, last_block)
//   returns     how many were written
std::int64_t ProjectGaussians(const GaussianCamera& camera, int order,
                              std::span<const float> parameters, std::int64_t first_block,
                              std::int64_t last_block, ProjectedGaussian* out);

// The gradients of one block, from those of its projections.
struct ProjectionGradients {
  std::span<const GaussianMoments, kGaussiansInBlock> moments;  // 0 for what is not visible
  // [GaussianRows(order)][16], written.
  std::span<float> parameters;
  // Length of the gradient by the position in the picture, written.
  std::span<float, kGaussiansInBlock> on_screen;
};

// The backward pass of the block of which `block` has the parameters. Exact, but for the rows of
// means beyond camera.most_ideal and of bounded scales, where it is that of the continued form.
//   pose  added to, if it is not null
void ProjectGaussiansBackward(const GaussianCamera& camera, int order, std::span<const float> block,
                              const ProjectionGradients& gradients, CameraGradient* pose);

}  // namespace nerf::kernels
