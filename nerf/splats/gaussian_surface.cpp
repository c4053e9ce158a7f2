#include "nerf/kernels/gaussian_surface.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "nerf/base/parallel.h"
#include "nerf/splats/gaussian_renderer.h"

namespace nerf {
namespace {

using kernels::kGaussiansInBlock;
using kernels::kTileHeight;
using kernels::kTileWidth;

constexpr std::int64_t kNormalsAtOnce = 4096;

// The shortest axis of a Gaussian, towards the camera.
std::array<float, 3> NormalOf(const GaussianParameters& parameters, std::uint32_t index,
                              const Eigen::Vector3f& camera_centre) {
  const std::span<const float> block = parameters.Block(index / kGaussiansInBlock);
  const auto at = [&](int row) {
    return block[static_cast<std::size_t>(row) * kGaussiansInBlock + index % kGaussiansInBlock];
  };
  const auto three = [&](int row) { return Eigen::Vector3f(at(row), at(row + 1), at(row + 2)); };
  Eigen::Vector4f q(at(kernels::kRotationRow), at(kernels::kRotationRow + 1),
                    at(kernels::kRotationRow + 2), at(kernels::kRotationRow + 3));
  const float largest = q.cwiseAbs().maxCoeff();  // first: a square may be too small for float
  q = largest > 0 ? Eigen::Vector4f((q / largest).normalized()) : Eigen::Vector4f(1, 0, 0, 0);
  Eigen::Index shortest = 0;
  three(kernels::kLogScaleRow).minCoeff(&shortest);
  Eigen::Vector3f normal =
      Eigen::Quaternionf(q[0], q[1], q[2], q[3]).toRotationMatrix().col(shortest);
  if (normal.dot(three(kernels::kMeanRow) - camera_centre) > 0) normal *= -1;
  return {normal.x(), normal.y(), normal.z()};
}

}  // namespace

GaussianSurface GaussianRenderer::FindSurface(const kernels::GaussianCamera& camera,
                                              const GaussianParameters& parameters) const {
  std::vector<std::array<float, 3>> normals(sorted_.size());
  const Eigen::Vector3f centre(camera.center[0], camera.center[1], camera.center[2]);
  ParallelFor(static_cast<std::int64_t>(normals.size()), kNormalsAtOnce,
              [&](std::int64_t first, std::int64_t last) {
                for (std::int64_t i = first; i < last; ++i) {
                  normals[i] = NormalOf(parameters, sorted_[i].index, centre);
                }
              });
  GaussianSurface found;
  found.median_distance.resize(static_cast<std::size_t>(camera.width) * camera.height);
  found.normal.resize(found.median_distance.size());
  ParallelForEach(tiles_.Count(), [&](std::int64_t index) {
    const kernels::Tile tile = tiles_.At(static_cast<int>(index));
    kernels::TileSurface surface;
    kernels::FindTileSurface(sorted_, normals, tile, surface);
    for (int y = 0; y < std::min(kTileHeight, camera.height - tile.y); ++y) {
      for (int x = 0; x < std::min(kTileWidth, camera.width - tile.x); ++x) {
        const int from = y * kTileWidth + x;
        const std::size_t to = static_cast<std::size_t>(tile.y + y) * camera.width + tile.x + x;
        found.median_distance[to] = surface.median_distance[from];
        const Eigen::Vector3f sum(surface.normal[0][from], surface.normal[1][from],
                                  surface.normal[2][from]);
        const Eigen::Vector3f unit = sum.stableNormalized();
        found.normal[to] = {unit.x(), unit.y(), unit.z()};
      }
    }
  });
  return found;
}

}  // namespace nerf
