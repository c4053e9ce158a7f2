#pragma once

#include <random>
#include <vector>

#include "nerf/kernels/gaussians.h"
#include "nerf/reference/gaussians.h"

namespace nerf {

// The parameters of Gaussians in blocks, as the kernels take them.
inline std::vector<float> InBlocks(const std::vector<reference::Gaussian>& gaussians, int order) {
  using namespace kernels;
  const std::size_t rows = GaussianRows(order);
  const std::size_t blocks = (gaussians.size() + kGaussiansInBlock - 1) / kGaussiansInBlock;
  std::vector<float> values(blocks * rows * kGaussiansInBlock, 0.0f);
  const auto at = [&](std::size_t i, std::size_t row) -> float& {
    return values[(i / kGaussiansInBlock * rows + row) * kGaussiansInBlock + i % kGaussiansInBlock];
  };
  for (std::size_t i = 0; i < blocks * kGaussiansInBlock; ++i) at(i, kOpacityRow) = -30;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    const reference::Gaussian& g = gaussians[i];
    for (int k = 0; k < 3; ++k) {
      at(i, kMeanRow + k) = static_cast<float>(g.mean[k]);
      at(i, kLogScaleRow + k) = static_cast<float>(g.log_scale[k]);
    }
    for (int k = 0; k < 4; ++k) at(i, kRotationRow + k) = static_cast<float>(g.rotation[k]);
    at(i, kOpacityRow) = static_cast<float>(g.opacity);
    for (std::size_t k = 0; k < g.color.size(); ++k) {
      for (int c = 0; c < 3; ++c) at(i, kColorRow + 3 * k + c) = static_cast<float>(g.color[k][c]);
    }
  }
  return values;
}

// A parameter of a Gaussian by its row.
inline double& RowOf(reference::Gaussian& g, int row) {
  using namespace kernels;
  if (row < kLogScaleRow) return g.mean[row];
  if (row < kRotationRow) return g.log_scale[row - kLogScaleRow];
  if (row < kOpacityRow) return g.rotation[row - kRotationRow];
  if (row == kOpacityRow) return g.opacity;
  return g.color[(row - kColorRow) / 3][(row - kColorRow) % 3];
}

// Random Gaussians in front of a camera at the origin that looks along +z, at distances of 2 to 4.
inline std::vector<reference::Gaussian> RandomGaussians(int count, int order, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> one(-1, 1);
  std::vector<reference::Gaussian> gaussians(count);
  for (reference::Gaussian& g : gaussians) {
    g.mean = Eigen::Vector3d(one(random), 0.8 * one(random), 3 + one(random));
    g.log_scale =
        Eigen::Vector3d(one(random), one(random), one(random)) * 0.6 - Eigen::Vector3d::Constant(2);
    g.rotation = Eigen::Vector4d(one(random), one(random), one(random), one(random));
    g.opacity = 2 * one(random);
    g.color.resize(kernels::HarmonicsOf(order));
    for (Eigen::Vector3d& color : g.color) {
      color = 0.4 * Eigen::Vector3d(one(random), one(random), one(random));
    }
    // As float sees them.
    for (int row = 0; row < kernels::GaussianRows(order); ++row) {
      RowOf(g, row) = static_cast<float>(RowOf(g, row));
    }
  }
  return gaussians;
}

}  // namespace nerf
