#include "sfm/pose_consistency.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "nerf/scene/camera.h"
#include "sfm/triangulation.h"

namespace nerf::sfm {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kMaxError = 4;       // pixels
constexpr std::size_t kFewest = 100;  // matches
constexpr double kContradicts = 0.5;  // less than this share
constexpr double kFits = 0.85;        // more than this share
constexpr double kSamePlace = 1e-6;   // of the extent of the cameras
constexpr int kMostOfPair = 60;       // matches that are looked at, of a pair

// A match as two directions in the axes of the cameras.
struct Rays {
  ImagePair images;
  Vector3d first, second;
  double max_angle = 0;  // of the error, radians
};

std::vector<Rays> RaysOf(const PosedImages& posed, std::span<const SeenTwice> matches,
                         double max_error) {
  std::vector<Rays> rays;
  double extent = 0;  // cameras nearer to each other tell nothing about their poses
  for (const PosedImage& image : posed.images) {
    extent = std::max(extent, (image.world_from_camera.translation() -
                               posed.images.front().world_from_camera.translation())
                                  .norm());
  }
  for (const SeenTwice& pair : matches) {
    const double between = (posed.images[pair.images.first].world_from_camera.translation() -
                            posed.images[pair.images.second].world_from_camera.translation())
                               .norm();
    if (!(between > kSamePlace * extent)) continue;
    const Camera& a = posed.cameras[posed.images[pair.images.first].camera];
    const Camera& b = posed.cameras[posed.images[pair.images.second].camera];
    const double max_angle = max_error / std::min(FocalLength(a), FocalLength(b));
    const std::size_t step = (pair.in_first.size() + kMostOfPair - 1) / kMostOfPair;
    for (std::size_t i = 0; i < pair.in_first.size(); i += step) {
      const auto first = DirectionFromPixel(a, pair.in_first[i]);
      const auto second = DirectionFromPixel(b, pair.in_second[i]);
      if (first && second) rays.push_back({pair.images, *first, *second, max_angle});
    }
  }
  return rays;
}

// A mistake that may have been made: what undoes it.
struct Mistake {
  std::string text;
  std::function<Isometry3d(int image)> pose;
  Vector3d scale = Vector3d::Ones();  // of directions, by axes
};

bool Fits(const Rays& rays, const Mistake& mistake) {
  const Isometry3d a = mistake.pose(rays.images.first), b = mistake.pose(rays.images.second);
  const Vector3d first = a.linear() * mistake.scale.cwiseProduct(rays.first).normalized();
  const Vector3d second = b.linear() * mistake.scale.cwiseProduct(rays.second).normalized();
  const Vector3d between = b.translation() - a.translation();
  const auto angle_to_plane = [&](const Vector3d& of, const Vector3d& other) {
    const Vector3d normal = between.cross(other);
    const double length = normal.norm();
    return length > 1e-9 * between.norm() ? std::fabs(of.dot(normal)) / length : 0.0;
  };
  if (angle_to_plane(second, first) > rays.max_angle) return false;
  if (angle_to_plane(first, second) > rays.max_angle) return false;
  // Of what is far away, the rays are parallel but for their errors.
  if (first.cross(second).norm() <= 2 * rays.max_angle) return first.dot(second) > 0;
  return NearestToRays(a.translation(), first, b.translation(), second).has_value();
}

double ShareThatFits(std::span<const Rays> rays, const Mistake& mistake) {
  const auto fitting = std::ranges::count_if(rays, [&](const Rays& r) { return Fits(r, mistake); });
  return static_cast<double>(fitting) / static_cast<double>(rays.size());
}

std::vector<Mistake> KnownMistakes(const std::vector<Isometry3d>& poses) {
  const int count = static_cast<int>(poses.size());
  const auto given = [&poses](int i) { return poses[i]; };
  std::vector<Mistake> mistakes;
  // The axes of cameras were perhaps converted after it.
  const Eigen::DiagonalMatrix<double, 3> turned(1, -1, -1);
  for (const bool is_turned : {false, true}) {
    mistakes.push_back(
        {"the matrices are world-to-camera where camera-to-world is expected, or the "
         "other way round",
         [&poses, turned, is_turned](int i) {
           Isometry3d pose = poses[i].inverse();
           if (is_turned) pose.linear() = pose.linear() * turned;
           return pose;
         }});
  }
  const auto add_axes = [&](const std::string& text, double x, double y, double z) {
    mistakes.push_back({text, given, Vector3d(x, y, z)});
  };
  add_axes("the y and z axes of the cameras point the other way (OpenGL and OpenCV confused)", 1,
           -1, -1);
  add_axes("the photographs or the x axis of the cameras are mirrored", -1, 1, 1);
  add_axes("the photographs or the y axis of the cameras are mirrored", 1, -1, 1);
  add_axes("the cameras look along the opposite direction", 1, 1, -1);
  add_axes("the photographs are turned upside down", -1, -1, 1);
  for (int axis = 0; axis < 3; ++axis) {
    mistakes.push_back({fmt::format("the {} axis of the positions is mirrored", "xyz"[axis]),
                        [&poses, axis](int i) {
                          Isometry3d pose = poses[i];
                          pose.translation()[axis] *= -1;
                          return pose;
                        }});
  }
  for (double factor = 0.5; factor <= 2; factor *= 1.025) {
    if (std::fabs(factor - 1) < 0.02) continue;
    mistakes.push_back(
        {fmt::format("the focal length is {:.0f} % of what it should be", 100 / factor), given,
         Vector3d(1 / factor, 1 / factor, 1)});
  }
  for (const int shift : {-1, 1}) {
    mistakes.push_back(
        {"the names are shifted: each photograph has the pose of its neighbour",
         [&poses, shift, count](int i) { return poses[std::clamp(i + shift, 0, count - 1)]; }});
  }
  mistakes.push_back({"the names are in the reverse order of the poses",
                      [&poses, count](int i) { return poses[count - 1 - i]; }});
  return mistakes;
}

}  // namespace

std::vector<ImageFit> FitOfImages(const PosedImages& posed, std::span<const SeenTwice> matches,
                                  double max_error) {
  std::vector<ImageFit> fits(posed.images.size());
  const Mistake none{"", [&](int i) { return posed.images[i].world_from_camera; }};
  for (const Rays& rays : RaysOf(posed, matches, max_error)) {
    const int fitting = Fits(rays, none) ? 1 : 0;
    for (const int image : {rays.images.first, rays.images.second}) {
      ++fits[image].matches;
      fits[image].fitting += fitting;
    }
  }
  return fits;
}

bool PoseConsistency::Contradicts() const { return share < kContradicts; }

std::string Describe(const PoseConsistency& consistency) {
  if (std::isnan(consistency.share)) {
    return "the photographs have too few matches to tell whether the poses are right";
  }
  std::string text = fmt::format("{:.0f} % of the matches between photographs fit the poses",
                                 100 * consistency.share);
  if (!consistency.IsDoubtful()) return text;
  if (consistency.looks_like.empty()) {
    return text + "; names and poses do not belong together (shuffled), or many poses are wrong";
  }
  return text + fmt::format("; it looks as if {}: {:.0f} % would fit then", consistency.looks_like,
                            100 * consistency.share_then);
}

PoseConsistency CheckPoses(const PosedImages& posed, std::span<const SeenTwice> matches) {
  PoseConsistency result;
  const std::vector<Rays> rays = RaysOf(posed, matches, kMaxError);
  if (rays.size() < kFewest) {
    result.share = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  std::vector<Isometry3d> poses;
  for (const PosedImage& image : posed.images) poses.push_back(image.world_from_camera);
  result.share = ShareThatFits(rays, {"", [&](int i) { return poses[i]; }});
  if (result.share >= kFits) return result;
  for (const Mistake& mistake : KnownMistakes(poses)) {
    const double share = ShareThatFits(rays, mistake);
    if (share <= result.share_then) continue;
    result.share_then = share;
    result.looks_like = mistake.text;
  }
  // Whatever explains much of what does not fit. Lenses that are a little wrong are no mistake.
  if (1 - result.share_then > (1 - result.share) / 2) result.looks_like.clear();
  return result;
}

}  // namespace nerf::sfm
