#include "nerf/scene/depth_fusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "nerf/base/parallel.h"
#include "nerf/image/silhouette.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kOpaque = 0.5;
// Distances are interpolated between pixels that differ by at most so many cells: else there is an
// edge between them.
constexpr double kSmooth = 4;
constexpr float kUnseen = -1;
constexpr int kBlock = 4;  // cells, along an axis

// What one view says about points.
class Observer {
 public:
  Observer(const DepthMap& view, double cell)
      : view_(view),
        silhouette_(SilhouetteDistance(view.opacity)),
        cell_(cell),
        focal_(FocalLength(view.camera)),
        camera_from_grid_(view.grid_from_camera.inverse()) {}

  // The signed distance along the ray, in units of the truncation, at most 1; nullopt: nothing.
  std::optional<double> DistanceOf(const Eigen::Vector3d& point, double truncation) const {
    const Eigen::Vector3d at = camera_from_grid_ * point;
    const auto pixel = PixelFromPoint(view_.camera, at);
    if (!pixel) return std::nullopt;
    const double x = pixel->x() - 0.5, y = pixel->y() - 0.5;
    if (!(x >= 0 && y >= 0 && x < view_.camera.width - 1 && y < view_.camera.height - 1)) {
      return std::nullopt;
    }
    const std::optional<double> surface = SurfaceAt(x, y);
    if (!surface) return std::nullopt;
    // Beside a silhouette the surface is no farther away than that.
    const double aside = AsideAt(x, y) * at.norm() / focal_;
    double distance = std::max(aside, 0.0);
    if (!std::isinf(*surface)) {
      distance = *surface - at.norm();
      if (distance < -truncation) return std::nullopt;
      if (distance < 0) distance = std::max(distance, std::min(aside, 0.0));
    }
    return std::min(1.0, distance / truncation);
  }

 private:
  // Infinite where the view is transparent; nullopt at the edge of something.
  std::optional<double> SurfaceAt(double x, double y) const {
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const double across = x - left, down = y - top;
    const std::array<double, 4> weights = {(1 - across) * (1 - down), across * (1 - down),
                                           (1 - across) * down, across * down};
    std::array<double, 4> seen{}, opacities{};
    double opacity = 0, distance = 0;
    for (int k = 0; k < 4; ++k) {
      const int u = left + (k & 1), v = top + (k >> 1);
      seen[k] = static_cast<double>(*view_.distance.At(u, v));
      opacities[k] = static_cast<double>(*view_.opacity.At(u, v));
      opacity += weights[k] * opacities[k];
      distance += weights[k] * seen[k];
    }
    if (opacity < kOpaque) return std::numeric_limits<double>::infinity();
    const auto [nearest, farthest] = std::ranges::minmax(seen);
    const bool is_smooth =
        std::ranges::min(opacities) >= kOpaque && farthest - nearest < kSmooth * cell_;
    if (is_smooth) return distance;
    const auto k = std::ranges::max_element(weights) - weights.begin();
    return opacities[k] < kOpaque ? std::nullopt : std::optional(seen[k]);
  }

  // The distance to the silhouette, in pixels.
  double AsideAt(double x, double y) const {
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const double across = x - left, down = y - top;
    const auto at = [&](int u, int v) {
      return static_cast<double>(*silhouette_.At(left + u, top + v));
    };
    if (std::isinf(at(0, 0))) return at(0, 0);
    return (1 - down) * ((1 - across) * at(0, 0) + across * at(1, 0)) +
           down * ((1 - across) * at(0, 1) + across * at(1, 1));
  }

  const DepthMap& view_;
  Image silhouette_;
  double cell_, focal_;
  Eigen::Isometry3d camera_from_grid_;
};

// The mean of what views say; kUnseen where they say nothing.
float Fused(const std::vector<Observer>& observers, const Eigen::Vector3d& point,
            double truncation) {
  double sum = 0;
  int count = 0;
  for (const Observer& observer : observers) {
    if (const auto distance = observer.DistanceOf(point, truncation)) {
      sum += *distance;
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count) : kUnseen;
}

ScalarGrid EmptyGrid(const Eigen::AlignedBox3d& box, double cell) {
  ScalarGrid grid;
  grid.origin = box.min();
  grid.cell = cell;
  grid.size = (box.sizes() / cell).array().ceil().matrix().cast<int>() + Eigen::Vector3i::Ones();
  grid.size = grid.size.cwiseMax(2);
  grid.values.resize(grid.Index(0, 0, grid.size.z()));
  return grid;
}

//   value  called with the indices of each value
template <class Value>
void Fill(ScalarGrid& grid, const Value& value) {
  ParallelForEach(grid.size.z(), [&](std::int64_t z) {
    for (int y = 0; y < grid.size.y(); ++y) {
      for (int x = 0; x < grid.size.x(); ++x) {
        grid.values[grid.Index(x, y, static_cast<int>(z))] = value(x, y, static_cast<int>(z));
      }
    }
  });
}

// Of a block of cells, the value that all its corners have; nullopt: they differ, or it is neither
// free nor unknown.
std::optional<float> Uniform(const ScalarGrid& blocks, int x, int y, int z) {
  const float first = blocks.values[blocks.Index(x, y, z)];
  if (first != 1 && first != kUnseen) return std::nullopt;
  for (int c = 1; c < 8; ++c) {
    const Eigen::Vector3i at(std::min(x + (c & 1), blocks.size.x() - 1),
                             std::min(y + (c >> 1 & 1), blocks.size.y() - 1),
                             std::min(z + (c >> 2), blocks.size.z() - 1));
    if (blocks.values[blocks.Index(at.x(), at.y(), at.z())] != first) return std::nullopt;
  }
  return first;
}

}  // namespace

ScalarGrid FuseDepth(const std::vector<DepthMap>& views, const FusionBox& where) {
  std::vector<Observer> observers;
  for (const DepthMap& view : views) observers.emplace_back(view, where.cell);
  const double truncation = where.cell * where.truncation;
  // Most of space is free or unknown. Where it is at all corners of a block, with a truncation of
  // more than the block's diagonal, it is within.
  ScalarGrid blocks = EmptyGrid(where.box, kBlock * where.cell);
  const double of_block = truncation + std::sqrt(3) * blocks.cell;
  Fill(blocks,
       [&](int x, int y, int z) { return Fused(observers, blocks.PositionOf(x, y, z), of_block); });
  ScalarGrid grid = EmptyGrid(where.box, where.cell);
  Fill(grid, [&](int x, int y, int z) {
    if (const auto all = Uniform(blocks, x / kBlock, y / kBlock, z / kBlock)) return *all;
    return Fused(observers, grid.PositionOf(x, y, z), truncation);
  });
  return grid;
}

}  // namespace nerf
