#include "nerf/synthetic/perturbed_poses.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/scene/camera.h"
#include "nerf/synthetic/hash.h"
#include "nerf/synthetic/scenario.h"

namespace nerf::synthetic {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTurn = 0.4 * std::numbers::pi / 180;  // standard deviation along each axis
constexpr double kShift = 0.012;                        // the same, scene units

// A standard normal number, the i-th of a view. Source: Box and Muller 1958.
double Normal(int i, int view, unsigned seed) {
  const double u = 1 - UnitFromHash(Hash(view, i, 11, seed));
  const double v = UnitFromHash(Hash(view, i, 12, seed));
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

Vector3d NormalPoint(int i, int view, unsigned seed) {
  return {Normal(i, view, seed), Normal(i + 1, view, seed), Normal(i + 2, view, seed)};
}

Matrix3d CrossMatrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// The Jacobian of a camera's position and rotation with respect to a small similarity of the world
// (translation, rotation, scale); rows in units of the standard deviations.
Eigen::Matrix<double, 6, 7> SimilarityJacobian(const Vector3d& center) {
  Eigen::Matrix<double, 6, 7> rows;
  rows << Matrix3d::Identity() / kShift, -CrossMatrix(center) / kShift, center / kShift,
      Matrix3d::Zero(), Matrix3d::Identity() / kTurn, Vector3d::Zero();
  return rows;
}

Eigen::Isometry3d Moved(const Eigen::Isometry3d& world_from_camera, const Vector3d& shift,
                        const Vector3d& turn) {
  Eigen::Isometry3d moved = world_from_camera;
  moved.translation() += shift;
  const double angle = turn.norm();
  if (angle > 0) {
    moved.linear() = Eigen::AngleAxisd(angle, turn / angle) * world_from_camera.linear();
  }
  return moved;
}

void UpdateReprojectionErrors(PosedImages& posed) {
  for (SparsePoint& point : posed.points) {
    double sum = 0;
    int count = 0;
    for (const TrackElement& seen : point.track) {
      const PosedImage& image = posed.images[seen.image];
      const auto pixel = PixelFromPoint(posed.cameras[image.camera],
                                        image.world_from_camera.inverse() * point.x_in_world);
      if (!pixel) continue;
      sum += (*pixel - seen.pixel).norm();
      ++count;
    }
    if (count > 0) point.reprojection_error = sum / count;
  }
}

}  // namespace

PosedImages WithPerturbedPoses(const PosedImages& posed, unsigned seed) {
  std::vector<int> perturbed;
  for (int i = 0; i < static_cast<int>(posed.images.size()); ++i) {
    if (!IsHeldOut(i)) perturbed.push_back(i);
  }
  const auto rows = static_cast<Eigen::Index>(6 * perturbed.size());
  Eigen::MatrixXd similarity(rows, 7);
  Eigen::VectorXd error(rows);  // in units of the standard deviations
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    similarity.middleRows<6>(row) =
        SimilarityJacobian(posed.images[perturbed[k]].world_from_camera.translation());
    error.segment<3>(row) = NormalPoint(0, perturbed[k], seed);
    error.segment<3>(row + 3) = NormalPoint(3, perturbed[k], seed);
  }
  error -= similarity * similarity.completeOrthogonalDecomposition().solve(error);
  PosedImages moved = posed;
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    Eigen::Isometry3d& pose = moved.images[perturbed[k]].world_from_camera;
    pose = Moved(pose, kShift * error.segment<3>(row), kTurn * error.segment<3>(row + 3));
  }
  UpdateReprojectionErrors(moved);
  return moved;
}

}  // namespace nerf::synthetic
