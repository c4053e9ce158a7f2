#include "nerf/inspect/visual_hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

constexpr int kCells = 64;   // along each axis of the cube
constexpr double kHalf = 2;  // its half width
constexpr double kCell = 2 * kHalf / kCells;
// A cell counts as occupied where enough photographs see it, none of them empty: 2 at least, and
// one in 4 of those examined.
constexpr int kFewestSights = 2, kShareOfSights = 4;
constexpr std::size_t kMostPhotographs = 40;  // more would hardly make the hull smaller
constexpr double kMargin = 1.02;              // so that nothing is on the surface of the ball

Vector3d Corner(int x, int y, int z) {
  return Vector3d(x, y, z) * kCell - Vector3d::Constant(kHalf);
}

// Summed-area table: the number of pixels that are not transparent above and left of each pixel
// corner, [h+1, w+1].
std::vector<std::int32_t> OpaqueSums(const Image& photo) {
  const std::size_t across = photo.width + 1;
  std::vector<std::int32_t> sums(across * (photo.height + 1), 0);
  for (int y = 0; y < photo.height; ++y) {
    std::int32_t row = 0;
    for (int x = 0; x < photo.width; ++x) {
      row += photo.At(x, y)[3] > 0 ? 1 : 0;
      sums[(y + 1) * across + x + 1] = sums[y * across + x + 1] + row;
    }
  }
  return sums;
}

// How a photograph sees a cell.
enum class Sight { kNotSeen, kEmpty, kMaybeOccupied };

Sight SightOf(const Camera& camera, const Eigen::Isometry3d& camera_from_normalized,
              const std::vector<std::int32_t>& opaque, int cx, int cy, int cz) {
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int k = 0; k < 8; ++k) {
    const Vector3d x =
        camera_from_normalized * Corner(cx + (k & 1), cy + (k >> 1 & 1), cz + (k >> 2));
    const auto pixel = PixelFromPoint(camera, x);
    if (!pixel) return Sight::kNotSeen;
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  if (low.x() < 0 || low.y() < 0 || high.x() >= camera.width || high.y() >= camera.height) {
    return Sight::kNotSeen;
  }
  const auto x0 = static_cast<std::size_t>(low.x()), y0 = static_cast<std::size_t>(low.y());
  const auto x1 = static_cast<std::size_t>(high.x()) + 1,
             y1 = static_cast<std::size_t>(high.y()) + 1;
  const std::size_t across = camera.width + 1;
  const std::int32_t count = opaque[y1 * across + x1] - opaque[y0 * across + x1] -
                             opaque[y1 * across + x0] + opaque[y0 * across + x0];
  return count == 0 ? Sight::kEmpty : Sight::kMaybeOccupied;
}

}  // namespace

std::optional<Ball> BoundingBallOfHull(const PosedImages& posed,
                                       const SceneNormalization& normalized_from_world,
                                       const std::function<void(int)>& read) {
  // The number of photographs that see each cell, or kEmpty where one of them sees it empty.
  constexpr int kEmpty = -1;
  std::vector<int> seen(kCells * kCells * kCells, 0);
  const std::size_t examined = std::min(kMostPhotographs, posed.images.size());
  for (std::size_t k = 0; k < examined; ++k) {
    const PosedImage& image = posed.images[k * posed.images.size() / examined];
    if (read) read(static_cast<int>(k) + 1);
    const Camera& camera = posed.cameras[image.camera];
    Image photo;
    try {
      photo = ReadImage(image.path, image.upright_by_exif);
    } catch (const InputError&) {
      continue;  // training reports and skips it
    }
    if (photo.channels != 4 || photo.width != camera.width || photo.height != camera.height)
      continue;
    const std::vector<std::int32_t> opaque = OpaqueSums(photo);
    const Eigen::Isometry3d camera_from_normalized =
        normalized_from_world.NormalizedFromCamera(image.world_from_camera).inverse();
    ParallelForEach(kCells, [&](std::int64_t z) {
      for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
          int& count = seen[(z * kCells + y) * kCells + x];
          if (count == kEmpty) continue;
          const Sight sight =
              SightOf(camera, camera_from_normalized, opaque, x, y, static_cast<int>(z));
          if (sight == Sight::kEmpty) count = kEmpty;
          if (sight == Sight::kMaybeOccupied) ++count;
        }
      }
    });
  }
  const int fewest = std::max(kFewestSights, static_cast<int>(examined) / kShareOfSights);
  Vector3d low = Vector3d::Constant(kHalf), high = -low;
  std::vector<Vector3d> corners;
  for (int z = 0; z < kCells; ++z) {
    for (int y = 0; y < kCells; ++y) {
      for (int x = 0; x < kCells; ++x) {
        if (seen[(z * kCells + y) * kCells + x] < fewest) continue;
        const int nearest = std::min({x, y, z}), farthest = std::max({x, y, z});
        if (nearest == 0 || farthest == kCells - 1) return std::nullopt;
        for (int k = 0; k < 8; ++k) {
          corners.push_back(Corner(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)));
          low = low.cwiseMin(corners.back());
          high = high.cwiseMax(corners.back());
        }
      }
    }
  }
  if (corners.empty()) return std::nullopt;
  Ball ball = {(low + high) / 2, 0};
  for (const Vector3d& x : corners) ball.radius = std::max(ball.radius, (x - ball.centre).norm());
  ball.radius *= kMargin;
  return ball;
}

SceneNormalization NormalizedTo(const Ball& ball, SceneNormalization normalized_from_world) {
  normalized_from_world.scale /= ball.radius;
  normalized_from_world.translation =
      (normalized_from_world.translation - ball.centre) / ball.radius;
  return normalized_from_world;
}

}  // namespace nerf
