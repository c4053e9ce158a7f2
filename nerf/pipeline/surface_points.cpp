#include "nerf/pipeline/surface_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "nerf/base/parallel.h"
#include "nerf/base/quantile.h"
#include "nerf/base/random.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr double kPixelsForPoint = 8;
constexpr double kDepthQuality = 0.5;  // of rendering
constexpr float kOpaque = 0.5f;
constexpr double kAgreement = 0.02;                         // of the distance
constexpr double kFar = 4;                                  // normalized units
constexpr int kViewsThatAgree = 2;                          // beside that of the point
constexpr double kSmallestVoxel = 1e-4, kLargestVoxel = 1;  // normalized units
constexpr int kBisections = 16;
constexpr double kNearest = 0.02;  // quantile of the distances in a view
// A sky, where views see no surface, is so many times as far away as the farthest camera that a
// pixel of it is the same for all cameras.
constexpr double kSkyPixels = 2;   // times the distance of a camera, in both directions
constexpr double kLeastSky = 500;  // normalized units

struct DepthView {
  Camera camera;
  Eigen::Isometry3d normalized_from_camera;
  RenderedView rendered;

  // The distance of what is seen at a pixel; 0 where it is empty.
  double DistanceAt(int x, int y) const {
    return *rendered.opacity.At(x, y) > kOpaque ? *rendered.depth.At(x, y) : 0.0f;
  }
  ColoredPoint PointAt(const Eigen::Vector3d& direction, double distance, int x, int y) const {
    const float* const rgb = rendered.rgb.At(x, y);
    return {normalized_from_camera * (distance * direction),
            Eigen::Vector3f(rgb[0], rgb[1], rgb[2])};
  }
  bool Agrees(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = normalized_from_camera.inverse() * point;
    const auto pixel = PixelFromPoint(camera, p);
    if (!pixel) return false;
    const double x = std::floor(pixel->x()), y = std::floor(pixel->y());
    if (!(x >= 0 && y >= 0 && x < camera.width && y < camera.height)) return false;
    const double seen = DistanceAt(static_cast<int>(x), static_cast<int>(y));
    // Far away a view cannot tell distances, since nothing moves before it.
    const double distance = p.norm(), tolerance = kAgreement * (1 + distance / kFar);
    return seen > 0 && std::abs(seen - distance) < tolerance * distance;
  }
};

//   sky  distance of points where rays meet no surface; 0: there are none
std::vector<ColoredPoint> PointsOf(const std::vector<DepthView>& views, std::size_t of,
                                   double sky) {
  const DepthView& view = views[of];
  std::vector<ColoredPoint> points;
  for (int y = 0; y < view.camera.height; ++y) {
    for (int x = 0; x < view.camera.width; ++x) {
      const double distance = view.DistanceAt(x, y);
      if (distance == 0 && sky == 0) continue;
      const auto direction = DirectionFromPixel(view.camera, {x + 0.5, y + 0.5});
      if (!direction) continue;
      if (distance == 0) {
        points.push_back(view.PointAt(*direction, sky, x, y));
        continue;
      }
      const ColoredPoint point = view.PointAt(*direction, distance, x, y);
      int agreeing = 0;
      for (std::size_t other = 0; other < views.size() && agreeing < kViewsThatAgree; ++other) {
        if (other != of && views[other].Agrees(point.x_in_normalized)) ++agreeing;
      }
      if (agreeing >= kViewsThatAgree) points.push_back(point);
    }
  }
  return points;
}

double SkyDistance(const std::vector<TargetView>& views) {
  double distance = kLeastSky;
  for (const TargetView& view : views) {
    const double pixels = FocalLength(view.camera);  // in a direction of 1 radian
    distance =
        std::max(distance, kSkyPixels * view.normalized_from_camera.translation().norm() * pixels);
  }
  return distance;
}

// In contracted space: the farther away, the larger.
std::uint64_t VoxelOf(const Eigen::Vector3d& x, double size) {
  const double norm = x.norm();
  const Eigen::Vector3d point = norm > 1 ? Eigen::Vector3d((2 - 1 / norm) / norm * x) : x;
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    key = Mix64(key ^
                static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(point[k] / size))));
  }
  return key;
}

std::vector<ColoredPoint> OneInEachVoxel(const std::vector<ColoredPoint>& points, double size) {
  std::unordered_set<std::uint64_t> taken;
  std::vector<ColoredPoint> kept;
  for (const ColoredPoint& point : points) {
    if (taken.insert(VoxelOf(point.x_in_normalized, size)).second) kept.push_back(point);
  }
  return kept;
}

// The least distance that views see, normalized units.
double NearestOf(const std::vector<DepthView>& views) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const DepthView& view : views) {
    std::vector<float> distances;
    for (const float distance : view.rendered.depth.pixels) {
      if (distance > 0) distances.push_back(distance);
    }
    if (distances.empty()) continue;
    nearest = std::min<double>(nearest, Quantile(distances, kNearest));
  }
  return nearest;
}

// The smallest voxels that leave no more than wanted.
double VoxelSizeFor(const std::vector<ColoredPoint>& points, std::int64_t wanted) {
  double low = std::log(kSmallestVoxel), high = std::log(kLargestVoxel);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (low + high) / 2;
    const auto left = static_cast<std::int64_t>(OneInEachVoxel(points, std::exp(middle)).size());
    (left > wanted ? low : high) = middle;
  }
  return std::exp(high);
}

}  // namespace

std::optional<SurfacePoints> FindSurfacePoints(const SceneModel& model,
                                               const std::vector<TargetView>& views,
                                               std::int64_t wanted, const std::atomic<bool>& stop,
                                               const std::function<void(std::size_t)>& progress) {
  double pixels = 0;
  for (const TargetView& view : views) pixels += static_cast<double>(PixelCount(view.camera));
  const double reduction = std::sqrt(pixels / (kPixelsForPoint * static_cast<double>(wanted)));
  const SceneNormalization& frame = model.Scene().normalized_from_world;
  std::vector<DepthView> rendered;
  for (const TargetView& view : views) {
    const int most = std::max(1, std::min(view.camera.width, view.camera.height) / 16);
    const int factor = std::clamp(static_cast<int>(std::lround(reduction)), 1, most);
    const Camera camera = Downscaled(view.camera, factor);
    rendered.push_back({camera, view.normalized_from_camera,
                        model.Render({camera, frame.WorldFromCamera(view.normalized_from_camera),
                                      kDepthQuality})});
    progress(rendered.size());
    if (stop) return std::nullopt;
  }
  const double sky = model.Scene().has_alpha ? 0 : SkyDistance(views);
  std::vector<std::vector<ColoredPoint>> of_view(rendered.size());
  ParallelForEach(static_cast<std::int64_t>(rendered.size()), [&](std::int64_t i) {
    of_view[i] = PointsOf(rendered, static_cast<std::size_t>(i), sky);
  });
  std::vector<ColoredPoint> points;
  for (const auto& own : of_view) points.insert(points.end(), own.begin(), own.end());
  const auto is_near = [&](const ColoredPoint& point) {
    return sky == 0 || point.x_in_normalized.norm() < sky / 2;
  };
  if (std::ranges::none_of(points, is_near)) points.clear();
  return SurfacePoints{OneInEachVoxel(points, VoxelSizeFor(points, wanted)), NearestOf(rendered)};
}

}  // namespace nerf
