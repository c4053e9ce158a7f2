#include "nerf/scene/rigid_pose.h"

#include <Eigen/SVD>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

// Largest deviation of the products of axes that counts as rounding.
constexpr double kRigid = 1e-3;

double DeviationFromOrthonormal(const Eigen::Matrix3d& axes) {
  return (axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

Eigen::Isometry3d RotatedAboutX(Eigen::Isometry3d world_from_camera) {
  world_from_camera.linear().rightCols<2>() *= -1;
  return world_from_camera;
}

}  // namespace

Eigen::Isometry3d RigidFromMatrix(const Eigen::Matrix4d& matrix, std::string_view where) {
  if (!matrix.allFinite()) throw InputError("{}: an entry is not finite", where);
  if (!matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6)) {
    throw InputError("{}: the last row is not 0 0 0 1", where);
  }
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double deviation = DeviationFromOrthonormal(linear);
  if (!(deviation <= kRigid)) {
    throw InputError("{}: not a rigid motion: its axes are not unit and orthogonal (off by {:.3g})",
                     where, deviation);
  }
  if (linear.determinant() <= 0) {
    throw InputError("{}: not a rigid motion: its axes are mirrored (determinant below 0)", where);
  }
  // Nearest rotation in the Frobenius norm: R = U V^T (Schoenemann 1966).
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  rigid.linear() = svd.matrixU() * svd.matrixV().transpose();
  rigid.translation() = matrix.topRightCorner<3, 1>();
  return rigid;
}

ScaledPose RigidFromScaledMatrix(Eigen::Matrix4d matrix, std::string_view where) {
  const Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
  const Eigen::Vector3d lengths = axes.colwise().norm();
  const double scale = lengths.mean();
  if (!axes.allFinite() || DeviationFromOrthonormal(axes) <= kRigid || !(scale > 0)) {
    return {RigidFromMatrix(matrix, where), 1};
  }
  if (DeviationFromOrthonormal(axes / scale) > kRigid) {
    throw InputError(
        "{}: not a rigid motion: its axes are not orthogonal or have different scales ({:.4g}, "
        "{:.4g}, {:.4g}); export the poses without scale",
        where, lengths[0], lengths[1], lengths[2]);
  }
  matrix.topLeftCorner<3, 3>() /= scale;
  return {RigidFromMatrix(matrix, where), scale};
}

Eigen::Matrix4d PoseMatrixFromJson(const nlohmann::json& value, std::string_view where) {
  constexpr Eigen::Index kColumns = 4;
  const bool nested = value.is_array() && !value.empty() && value.front().is_array();
  const std::size_t entries = nested ? kColumns * value.size() : value.size();
  bool has_shape = value.is_array() && (entries == 12 || entries == 16);
  for (std::size_t i = 0; nested && i < value.size(); ++i) {
    has_shape = has_shape && value[i].is_array() && value[i].size() == kColumns;
  }
  if (!has_shape) {
    throw InputError("{} must be 4 lists of 4 numbers (or 3, or one list of 16 or 12)", where);
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t row = i / kColumns, column = i % kColumns;
    const nlohmann::json& entry = nested ? value[row][column] : value[i];
    if (!entry.is_number()) {
      throw InputError("{}[{}][{}] must be a finite number", where, row, column);
    }
    matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = entry.get<double>();
  }
  return matrix;
}

Eigen::Isometry3d WorldFromOpenCVCamera(const Eigen::Isometry3d& world_from_opengl_camera) {
  return RotatedAboutX(world_from_opengl_camera);
}

Eigen::Isometry3d WorldFromOpenGLCamera(const Eigen::Isometry3d& world_from_opencv_camera) {
  return RotatedAboutX(world_from_opencv_camera);
}

}  // namespace nerf
