#include "nerf/output/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr int kMaxFrames = 100'000;

void Check(const PosedImages& images, int frames) {
  if (frames < 1 || frames > kMaxFrames) {
    throw InputError("frames {}: give 1 to {}", frames, kMaxFrames);
  }
  if (images.images.empty()) {
    throw InputError("{}: contains no cameras for a path", images.source.string());
  }
}

Camera WithoutDistortion(const PosedImages& images) {
  const Camera& camera = images.cameras[images.images.front().camera];
  const double focal = FocalLength(camera);
  const Eigen::Vector2d center = PrincipalPoint(camera);
  return {.model = CameraModel::kPinhole,
          .width = camera.width,
          .height = camera.height,
          .params = {focal, focal, center.x(), center.y()}};
}

// Whether the last pose is one step before the first, so that a film of the path loops smoothly.
enum class Ending { kClosed, kOpen };

// pose_at(t) for `frames` values of t from 0 to 1, excluding 1 for a closed path.
template <class PoseAt>
CameraPath Sample(const PosedImages& images, int frames, Ending ending, PoseAt pose_at) {
  CameraPath path;
  const Camera camera = WithoutDistortion(images);
  const int steps = std::max(1, ending == Ending::kClosed ? frames : frames - 1);
  for (int i = 0; i < frames; ++i) {
    path.poses.push_back({.world_from_camera = pose_at(static_cast<double>(i) / steps),
                          .camera = camera,
                          .seconds = i / path.frames_per_second});
  }
  return path;
}

// Statistics of the cameras; world frame.
struct Rig {
  Vector3d focus;
  Vector3d up;
  Vector3d mean_center = Vector3d::Zero();
  Vector3d mean_forward = Vector3d::Zero();  // not normalized
  bool looks_outwards;
};

Rig FindRig(const PosedImages& images, const SceneNormalization& normalized_from_world) {
  Rig rig{.focus = normalized_from_world.WorldFromNormalized(Vector3d::Zero()),
          .up = normalized_from_world.rotation.transpose() * Vector3d::UnitZ(),
          .looks_outwards = false};
  double towards_focus = 0;
  for (const PosedImage& image : images.images) {
    const Vector3d forward = image.world_from_camera.linear().col(2);
    rig.mean_center += image.world_from_camera.translation();
    rig.mean_forward += forward;
    towards_focus += (rig.focus - image.world_from_camera.translation()).dot(forward);
  }
  rig.mean_center /= static_cast<double>(images.images.size());
  rig.looks_outwards = towards_focus <= 0;
  return rig;
}

Isometry3d FromParts(const Eigen::Matrix3d& rotation, const Vector3d& center) {
  Isometry3d world_from_camera = Isometry3d::Identity();
  world_from_camera.linear() = rotation;
  world_from_camera.translation() = center;
  return world_from_camera;
}

// The poses that a path passes through, sorted by name.
std::vector<Isometry3d> TrainingPoses(const PosedImages& images) {
  std::vector<const PosedImage*> chosen;
  for (const PosedImage& image : images.images) {
    if (image.split == Split::kTrain || image.split == Split::kUnspecified) {
      chosen.push_back(&image);
    }
  }
  if (chosen.empty()) {
    throw InputError("{}: all images are held out; a path needs training images",
                     images.source.string());
  }
  std::ranges::sort(chosen, {}, &PosedImage::name);
  std::vector<Isometry3d> poses;
  for (const PosedImage* image : chosen) poses.push_back(image->world_from_camera);
  return poses;
}

// Between p1 (t = 0) and p2 (t = 1). Source: Catmull and Rom 1974.
Vector3d CatmullRom(const Vector3d& p0, const Vector3d& p1, const Vector3d& p2, const Vector3d& p3,
                    double t) {
  return 0.5 * (2 * p1 + t * (p2 - p0) + t * t * (2 * p0 - 5 * p1 + 4 * p2 - p3) +
                t * t * t * (3 * p1 - p0 - 3 * p2 + p3));
}

// The rotation vector from a to b, by the shorter way.
Vector3d RotationVector(const Quaterniond& a, const Quaterniond& b) {
  const Eigen::AngleAxisd turn(a.conjugate() * b);
  return turn.angle() * turn.axis();
}

// The inner control point of Shoemake 1987 at `here`, for a continuous angular velocity.
Quaterniond ControlPoint(const Quaterniond& before, const Quaterniond& here,
                         const Quaterniond& after) {
  const Vector3d bend = -0.25 * (RotationVector(here, before) + RotationVector(here, after));
  const double angle = bend.norm();
  if (angle == 0) return here;
  return here * Quaterniond(Eigen::AngleAxisd(angle, bend / angle));
}

// The i-th key, repeating the first and the last beyond the ends.
template <class T>
const T& Clamped(const std::vector<T>& keys, std::ptrdiff_t i) {
  return keys[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ssize(keys) - 1))];
}

}  // namespace

Isometry3d LookAt(const Vector3d& center, const Vector3d& target, const Vector3d& up) {
  const Vector3d forward = (target - center).normalized();
  Vector3d right = forward.cross(up.normalized());
  right = right.norm() > 1e-6 ? right.normalized() : forward.unitOrthogonal();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  return FromParts(axes, center);
}

CameraPath OrbitPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                     int frames) {
  Check(images, frames);
  const Rig rig = FindRig(images, normalized_from_world);
  double height = 0;
  double radius = 0;
  for (const PosedImage& image : images.images) {
    const Vector3d offset = image.world_from_camera.translation() - rig.focus;
    height += offset.dot(rig.up);
    radius += (offset - offset.dot(rig.up) * rig.up).norm();
  }
  height /= static_cast<double>(images.images.size());
  radius /= static_cast<double>(images.images.size());

  const Vector3d first = images.images.front().world_from_camera.translation() - rig.focus;
  Vector3d start = first - first.dot(rig.up) * rig.up;
  start = start.norm() > 1e-9 * first.norm() ? start.normalized() : rig.up.unitOrthogonal();
  const Vector3d side = rig.up.cross(start);
  return Sample(images, frames, Ending::kClosed, [&](double t) {
    const double angle = 2 * std::numbers::pi * t;
    const Vector3d outwards = std::cos(angle) * start + std::sin(angle) * side;
    const Vector3d center = rig.focus + radius * outwards + height * rig.up;
    return LookAt(center, rig.looks_outwards ? center + outwards : rig.focus, rig.up);
  });
}

CameraPath SpiralPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                      int frames) {
  Check(images, frames);
  const Rig rig = FindRig(images, normalized_from_world);
  const Vector3d forward = rig.mean_forward.norm() > 0
                               ? rig.mean_forward.normalized()
                               : images.images.front().world_from_camera.linear().col(2);
  const Isometry3d world_from_mean = LookAt(rig.mean_center, rig.mean_center + forward, rig.up);

  std::vector<double> offsets[3];
  for (const PosedImage& image : images.images) {
    const Vector3d x_in_mean = world_from_mean.inverse() * image.world_from_camera.translation();
    for (int axis = 0; axis < 3; ++axis) offsets[axis].push_back(std::abs(x_in_mean[axis]));
  }
  Vector3d widths;
  for (int axis = 0; axis < 3; ++axis) {
    widths[axis] = ValueOfRank(offsets[axis], offsets[axis].size() * 9 / 10);
  }
  double depth = (rig.focus - rig.mean_center).dot(forward);
  // Cameras that look outwards have no common focus in front of them; use a point far ahead.
  if (rig.looks_outwards || !(depth > 0)) depth = std::max(1e-6, 10 * widths.norm());
  const Vector3d focus = rig.mean_center + depth * forward;
  return Sample(images, frames, Ending::kClosed, [&](double t) {
    const double angle = 4 * std::numbers::pi * t;
    const Vector3d on_spiral(std::cos(angle), std::sin(angle), std::sin(angle / 2));
    return LookAt(world_from_mean * widths.cwiseProduct(on_spiral), focus, rig.up);
  });
}

CameraPath TrainingPath(const PosedImages& images, int frames) {
  Check(images, frames);
  const std::vector<Isometry3d> poses = TrainingPoses(images);
  std::vector<Vector3d> centers;
  std::vector<Quaterniond> rotations;
  for (const Isometry3d& pose : poses) {
    centers.push_back(pose.translation());
    rotations.emplace_back(pose.linear());
  }
  const auto last = static_cast<double>(poses.size() - 1);
  return Sample(images, frames, Ending::kOpen, [&](double t) {
    const auto i = static_cast<std::ptrdiff_t>(std::min(std::floor(t * last), last));
    const double u = t * last - static_cast<double>(i);
    const auto rotation = [&](std::ptrdiff_t key) { return Clamped(rotations, key); };
    const auto center = [&](std::ptrdiff_t key) { return Clamped(centers, key); };
    const Quaterniond inner =
        ControlPoint(rotation(i - 1), rotation(i), rotation(i + 1))
            .slerp(u, ControlPoint(rotation(i), rotation(i + 1), rotation(i + 2)));
    const Quaterniond turned = rotation(i).slerp(u, rotation(i + 1)).slerp(2 * u * (1 - u), inner);
    return FromParts(turned.normalized().toRotationMatrix(),
                     CatmullRom(center(i - 1), center(i), center(i + 1), center(i + 2), u));
  });
}

}  // namespace nerf
