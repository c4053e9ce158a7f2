#include "nerf/scene/scene_normalization.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/scene/camera_intrinsics.h"

namespace nerf {
namespace {

// Mean squared sine of the angle between the optical axes and their common direction, below which
// their intersection is undetermined (about 3 degrees), or less accurate than a known depth (10
// degrees).
constexpr double kLeastSpread = 0.003;
constexpr double kLeastSpreadWithDepth = 0.03;
// Length of the mean viewing direction from which the cameras count as forward-facing.
constexpr double kForwardFacing = 0.5;
// Distance to a scene of unknown depth, in units of the extent of the cameras in front of it.
constexpr double kDepthPerExtent = 4;
// Extent of the cameras, in units of the distance to the points, below which they count as one
// point.
constexpr double kOnePoint = 0.01;

struct Sphere {
  Eigen::Vector3d centre;  // relative to the mean camera centre
  double radius = 1;
};

// The cameras relative to their mean centre, so that positions far from the origin do not cancel.
class Rig {
 public:
  explicit Rig(const PosedImages& posed) : posed_(posed) {
    const double weight = 1.0 / static_cast<double>(posed.images.size());
    for (const PosedImage& image : posed.images) {
      origin_ += weight * image.world_from_camera.translation();
      mean_forward_ += weight * image.world_from_camera.linear().col(2);
      mean_up_ -= weight * image.world_from_camera.linear().col(1);
    }
    for (const PosedImage& image : posed.images) {
      centres_.push_back(image.world_from_camera.translation() - origin_);
      forwards_.push_back(image.world_from_camera.linear().col(2));
      const Camera& camera = posed.cameras[image.camera];
      const Eigen::Vector2d focal = FocalLengths(camera);
      half_widths_.push_back(0.5 * std::sqrt(camera.width / focal.x() * camera.height / focal.y()));
      extent_ = std::max(extent_, centres_.back().norm());
    }
  }

  const Eigen::Vector3d& origin() const { return origin_; }

  Sphere FindSphere() const {
    const auto depth = KnownDepth();
    if (const auto focus = FindFocus(depth ? kLeastSpreadWithDepth : kLeastSpread)) {
      std::vector<double> radii;
      for (std::size_t i = 0; i < centres_.size(); ++i) {
        radii.push_back((centres_[i] - *focus).norm() * half_widths_[i]);
      }
      return {*focus, UpperMedian(radii)};
    }
    if (mean_forward_.norm() >= kForwardFacing) return ForwardFacing(depth);
    return OutwardFacing();
  }

  // Rotates the mean up vector of the cameras to +z. Cameras that look straight down have none;
  // their backward axis is up.
  Eigen::Matrix3d UprightRotation() const {
    constexpr double kIsDirection = 0.1;
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    if (mean_up_.norm() > kIsDirection) {
      up = mean_up_;
    } else if (mean_forward_.norm() > kIsDirection) {
      up = -mean_forward_;
    }
    return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

 private:
  // The point with the smallest sum of distances to the optical axes; nullopt where the axes are
  // nearly parallel, or where it is behind more than a quarter of the cameras.
  std::optional<Eigen::Vector3d> FindFocus(double least_spread) const {
    if (extent_ == 0) return std::nullopt;
    std::vector<double> weights(centres_.size(), 1.0);
    Eigen::Vector3d focus = Eigen::Vector3d::Zero();
    constexpr int kIterations = 20;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      double sum = 0;
      for (std::size_t i = 0; i < centres_.size(); ++i) {
        const Eigen::Matrix3d across =
            Eigen::Matrix3d::Identity() - forwards_[i] * forwards_[i].transpose();
        normal += weights[i] * across;
        right += weights[i] * (across * centres_[i]);
        sum += weights[i];
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normal / sum);
      if (!(solver.eigenvalues()[0] >= least_spread)) return std::nullopt;
      focus =
          solver.eigenvectors() *
          (solver.eigenvectors().transpose() * (right / sum)).cwiseQuotient(solver.eigenvalues());
      for (std::size_t i = 0; i < centres_.size(); ++i) {
        const double distance = (focus - centres_[i]).cross(forwards_[i]).norm();
        weights[i] = 1 / std::max(distance / extent_, 1e-3);
      }
    }
    std::size_t behind = 0;
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      if ((focus - centres_[i]).dot(forwards_[i]) <= 1e-3 * extent_) ++behind;
    }
    if (4 * behind > centres_.size()) return std::nullopt;
    return focus;
  }

  std::optional<double> KnownDepth() const {
    if (posed_.depth_range_in_world) {
      const auto& [near, far] = *posed_.depth_range_in_world;
      return 2 / (1 / near + 1 / far);
    }
    std::vector<double> depths;
    for (const SparsePoint& point : posed_.points) {
      for (const TrackElement& seen : point.track) {
        const Eigen::Vector3d ray = point.x_in_world - origin_ - centres_[seen.image];
        const double depth = ray.dot(forwards_[seen.image]);
        if (depth > 0) depths.push_back(depth);
      }
    }
    if (depths.empty()) return std::nullopt;
    return UpperMedian(depths);
  }

  Sphere ForwardFacing(std::optional<double> known_depth) const {
    double depth = extent_ > 0 ? kDepthPerExtent * extent_ : 1;
    if (known_depth) depth = *known_depth;
    return {depth * mean_forward_.normalized(), depth * UpperMedian(std::vector(half_widths_))};
  }

  Sphere OutwardFacing() const {
    std::vector<double> distances;
    for (const SparsePoint& point : posed_.points) {
      distances.push_back((point.x_in_world - origin_).norm());
    }
    const double to_points = UpperMedian(distances);
    double radius = 2 * extent_;
    if (extent_ <= kOnePoint * to_points) radius = to_points;
    return {Eigen::Vector3d::Zero(), radius > 0 ? radius : 1};
  }

  const PosedImages& posed_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_forward_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_up_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> centres_;  // relative to origin_
  std::vector<Eigen::Vector3d> forwards_;
  std::vector<double> half_widths_;  // of the view at distance 1
  double extent_ = 0;                // largest distance of a camera from the mean
};

}  // namespace

Eigen::Vector3d SceneNormalization::NormalizedFromWorld(const Eigen::Vector3d& x_in_world) const {
  return scale * (rotation * x_in_world) + translation;
}

Eigen::Vector3d SceneNormalization::WorldFromNormalized(
    const Eigen::Vector3d& x_in_normalized) const {
  return rotation.transpose() * (x_in_normalized - translation) / scale;
}

Eigen::Isometry3d SceneNormalization::NormalizedFromCamera(
    const Eigen::Isometry3d& world_from_camera) const {
  Eigen::Isometry3d normalized_from_camera = Eigen::Isometry3d::Identity();
  normalized_from_camera.linear() = rotation * world_from_camera.linear();
  normalized_from_camera.translation() = NormalizedFromWorld(world_from_camera.translation());
  return normalized_from_camera;
}

Eigen::Isometry3d SceneNormalization::WorldFromCamera(
    const Eigen::Isometry3d& normalized_from_camera) const {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear() = rotation.transpose() * normalized_from_camera.linear();
  world_from_camera.translation() = WorldFromNormalized(normalized_from_camera.translation());
  return world_from_camera;
}

SceneNormalization NormalizeScene(const PosedImages& posed) {
  const Rig rig(posed);
  const Sphere sphere = rig.FindSphere();
  SceneNormalization result;
  result.scale = 1 / sphere.radius;
  result.rotation = rig.UprightRotation();
  result.translation = -result.scale * (result.rotation * (rig.origin() + sphere.centre));
  if (!std::isnormal(result.scale) || !result.translation.allFinite()) {
    throw InputError(
        "{}: the poses span {:.3g} units about ({:.3g}, {:.3g}, {:.3g}), out of the range of "
        "double "
        "arithmetic; check their units",
        posed.source.string(), sphere.radius, rig.origin().x(), rig.origin().y(), rig.origin().z());
  }
  return result;
}

}  // namespace nerf
