#include "sfm/triangulation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/scene/camera.h"

namespace nerf::sfm {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kMostPairs = 30;
constexpr int kIterations = 6;
constexpr double kParallel = 1e-10;  // squared sine

struct Sighting {
  const TrackElement* element;
  const Camera* camera;
  Eigen::Isometry3d camera_from_world;
  Vector3d origin, direction;  // of the ray, in the world
};

std::vector<Sighting> SightingsOf(const PosedImages& posed, std::span<const TrackElement> track) {
  std::vector<Sighting> sightings;
  for (const TrackElement& element : track) {
    const PosedImage& image = posed.images[element.image];
    const Camera& camera = posed.cameras[image.camera];
    const auto direction = DirectionFromPixel(camera, element.pixel);
    if (!direction) continue;
    sightings.push_back({&element, &camera, image.world_from_camera.inverse(),
                         image.world_from_camera.translation(),
                         image.world_from_camera.linear() * *direction});
  }
  return sightings;
}

std::optional<Vector2d> ErrorOf(const Sighting& sighting, const Vector3d& x) {
  const auto pixel = PixelFromPoint(*sighting.camera, sighting.camera_from_world * x);
  if (!pixel) return std::nullopt;
  return *pixel - sighting.element->pixel;
}

std::vector<const Sighting*> Agreeing(const std::vector<Sighting>& sightings, const Vector3d& x,
                                      double max_error) {
  std::vector<const Sighting*> agreeing;
  for (const Sighting& sighting : sightings) {
    const auto error = ErrorOf(sighting, x);
    if (error && error->norm() <= max_error) agreeing.push_back(&sighting);
  }
  return agreeing;
}

// The best of the points of some pairs: all, or pairs spread over the track.
std::optional<Vector3d> BestOfPairs(const std::vector<Sighting>& sightings, double max_error) {
  const std::size_t count = sightings.size(), pairs = count * (count - 1) / 2;
  const std::size_t step = std::max<std::size_t>(1, pairs / kMostPairs);
  std::optional<Vector3d> best;
  std::size_t most = 1, number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      if (number++ % step != 0) continue;
      const Sighting &a = sightings[i], &b = sightings[j];
      const auto x = NearestToRays(a.origin, a.direction, b.origin, b.direction);
      if (!x) continue;
      const std::size_t agreeing = Agreeing(sightings, *x, max_error).size();
      if (agreeing <= most) continue;
      best = x;
      most = agreeing;
    }
  }
  return best;
}

// Minimizes the sum of squared projection errors by Gauss-Newton, with central differences.
Vector3d Refined(const std::vector<const Sighting*>& sightings, Vector3d x) {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vector3d gradient = Vector3d::Zero();
    for (const Sighting* sighting : sightings) {
      const double h = 1e-5 * (x - sighting->origin).norm();
      const auto error = ErrorOf(*sighting, x);
      Eigen::Matrix<double, 2, 3> jacobian;
      bool projects = error.has_value();
      for (int axis = 0; projects && axis < 3; ++axis) {
        const auto above = ErrorOf(*sighting, x + h * Vector3d::Unit(axis));
        const auto below = ErrorOf(*sighting, x - h * Vector3d::Unit(axis));
        projects = above && below;
        if (projects) jacobian.col(axis) = (*above - *below) / (2 * h);
      }
      if (!projects) continue;
      squares += jacobian.transpose() * jacobian;
      gradient += jacobian.transpose() * *error;
    }
    const Vector3d step = squares.ldlt().solve(gradient);
    if (!step.allFinite()) return x;
    x -= step;
    if (step.norm() <= 1e-9 * x.norm()) break;
  }
  return x;
}

// The largest angle between two rays to a point, radians.
double LargestAngle(const std::vector<const Sighting*>& sightings, const Vector3d& x) {
  double smallest_cosine = 1;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    for (std::size_t j = i + 1; j < sightings.size(); ++j) {
      smallest_cosine = std::min(
          smallest_cosine,
          (x - sightings[i]->origin).normalized().dot((x - sightings[j]->origin).normalized()));
    }
  }
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

}  // namespace

std::optional<Vector3d> NearestToRays(const Vector3d& origin_a, const Vector3d& direction_a,
                                      const Vector3d& origin_b, const Vector3d& direction_b) {
  const Vector3d between = origin_b - origin_a;
  const double cosine = direction_a.dot(direction_b), squared_sine = 1 - cosine * cosine;
  if (squared_sine < kParallel) return std::nullopt;
  const double along_a =
      (between.dot(direction_a) - cosine * between.dot(direction_b)) / squared_sine;
  const double along_b =
      (cosine * between.dot(direction_a) - between.dot(direction_b)) / squared_sine;
  if (along_a <= 0 || along_b <= 0) return std::nullopt;
  return (origin_a + along_a * direction_a + origin_b + along_b * direction_b) / 2;
}

std::optional<SparsePoint> Triangulate(const PosedImages& posed,
                                       std::span<const TrackElement> track,
                                       const TriangulationOptions& options) {
  const std::vector<Sighting> sightings = SightingsOf(posed, track);
  if (sightings.size() < options.min_views) return std::nullopt;
  const auto start = BestOfPairs(sightings, options.max_error);
  if (!start) return std::nullopt;
  Vector3d x = Refined(Agreeing(sightings, *start, options.max_error), *start);
  x = Refined(Agreeing(sightings, x, options.max_error), x);  // of those that agree with that
  const auto agreeing = Agreeing(sightings, x, options.max_error);
  if (agreeing.size() < options.min_views ||
      LargestAngle(agreeing, x) < options.min_angle * std::numbers::pi / 180) {
    return std::nullopt;
  }
  SparsePoint point;
  point.x_in_world = x;
  for (const Sighting* sighting : agreeing) {
    point.track.push_back(*sighting->element);
    point.reprojection_error +=
        ErrorOf(*sighting, x)->norm() / static_cast<double>(agreeing.size());
  }
  return point;
}

}  // namespace nerf::sfm
