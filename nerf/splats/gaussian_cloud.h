#pragma once

#include <cstdint>
#include <vector>

#include "nerf/field/libtorch.h"
#include "nerf/splats/gaussian_renderer.h"

namespace nerf {

// Gaussians as one LibTorch tensor, in the layout of kernels/gaussians.h.
struct GaussianCloud {
  // All with an opacity of nearly 0 and a rotation of identity.
  GaussianCloud(std::int64_t count, int order);

  int order = 0;             // of the harmonics
  std::int64_t count = 0;    // of Gaussians; the last block may have more, which stay invisible
  torch::Tensor parameters;  // [blocks][GaussianRows(order)][16] float

  GaussianParameters Parameters() const;
  std::span<float> Values();
  float& At(std::int64_t gaussian, int row) { return Values()[Offset(gaussian, row)]; }
  float At(std::int64_t gaussian, int row) const {
    return Parameters().values[Offset(gaussian, row)];
  }
  // Where a parameter is in the tensor; the same for all tensors of this shape.
  std::size_t Offset(std::int64_t gaussian, int row) const {
    return static_cast<std::size_t>(
        (gaussian / kernels::kGaussiansInBlock * kernels::GaussianRows(order) + row) *
            kernels::kGaussiansInBlock +
        gaussian % kernels::kGaussiansInBlock);
  }
};

// An order of the Gaussians in which neighbours in space are mostly neighbours in memory: by the
// Morton code of their means. [count] indices.
std::vector<std::int64_t> SpatialOrder(const GaussianCloud& cloud);

// The cloud with its Gaussians in another order, of which there may be fewer.
GaussianCloud Reordered(const GaussianCloud& cloud, const std::vector<std::int64_t>& order);

}  // namespace nerf
