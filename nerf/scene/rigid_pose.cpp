#include "nerf/scene/rigid_pose.h"

#include <Eigen/SVD>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

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
  const double deviation =
      (linear.transpose() * linear - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= 1e-3)) {
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

Eigen::Isometry3d WorldFromOpenCVCamera(const Eigen::Isometry3d& world_from_opengl_camera) {
  return RotatedAboutX(world_from_opengl_camera);
}

Eigen::Isometry3d WorldFromOpenGLCamera(const Eigen::Isometry3d& world_from_opencv_camera) {
  return RotatedAboutX(world_from_opencv_camera);
}

}  // namespace nerf
