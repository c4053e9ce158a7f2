#include "nerf/geometry/scalar_grid.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/parallel.h"

namespace nerf {
namespace {

constexpr double kKernelRadius = 3;  // standard deviations

std::vector<float> GaussianKernel(double sigma) {
  const int radius = static_cast<int>(std::ceil(kKernelRadius * sigma));
  std::vector<float> kernel;
  float sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

void BlurAlong(ScalarGrid& grid, int axis, const std::vector<float>& kernel) {
  const int radius = static_cast<int>(kernel.size()) / 2;
  std::vector<float> blurred(grid.values.size());
  ParallelForEach(grid.size.z(), [&](std::int64_t z) {
    for (int y = 0; y < grid.size.y(); ++y) {
      for (int x = 0; x < grid.size.x(); ++x) {
        float sum = 0;
        for (int i = -radius; i <= radius; ++i) {
          Eigen::Vector3i at(x, y, static_cast<int>(z));
          at[axis] = std::clamp(at[axis] + i, 0, grid.size[axis] - 1);
          sum += kernel[i + radius] * grid.values[grid.Index(at.x(), at.y(), at.z())];
        }
        blurred[grid.Index(x, y, static_cast<int>(z))] = sum;
      }
    }
  });
  grid.values = std::move(blurred);
}

}  // namespace

double ScalarGrid::At(const Eigen::Vector3d& position) const {
  const Eigen::Vector3d in_cells = (position - origin) / cell;
  Eigen::Vector3i corner;
  Eigen::Vector3d within;
  for (int k = 0; k < 3; ++k) {
    const double inside = std::clamp(in_cells[k], 0.0, size[k] - 1.0);
    corner[k] = std::min(static_cast<int>(inside), size[k] - 2);
    within[k] = inside - corner[k];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    Eigen::Vector3i at = corner;
    for (int k = 0; k < 3; ++k) {
      const int upper = c >> k & 1;
      at[k] += upper;
      weight *= upper == 1 ? within[k] : 1 - within[k];
    }
    sum += weight * static_cast<double>(values[Index(at.x(), at.y(), at.z())]);
  }
  return sum;
}

Eigen::Vector3d ScalarGrid::Gradient(const Eigen::Vector3d& position) const {
  Eigen::Vector3d gradient;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = cell * Eigen::Vector3d::Unit(k);
    gradient[k] = (At(position + step) - At(position - step)) / (2 * cell);
  }
  return gradient;
}

void Blur(ScalarGrid& grid, double sigma) {
  if (sigma <= 0) return;
  const std::vector<float> kernel = GaussianKernel(sigma);
  for (int axis = 0; axis < 3; ++axis) BlurAlong(grid, axis, kernel);
}

}  // namespace nerf
