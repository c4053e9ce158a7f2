#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string_view>

namespace nerf {

// The rigid motion of a 4x4 matrix from a file, with R replaced by the nearest rotation.
//   matrix  [R t; 0 0 0 1], R orthonormal within 1e-3 and right-handed
//   where   the beginning of error messages: "transforms.json: frames[3].transform_matrix"
// Throws InputError when an entry is not finite, R is no rotation, or the last row differs.
Eigen::Isometry3d RigidFromMatrix(const Eigen::Matrix4d& matrix, std::string_view where);

// A pose whose axes had one scale in common, as those of a camera below a scaled parent.
struct ScaledPose {
  Eigen::Isometry3d pose;
  double scale = 1;  // taken out
};
// As RigidFromMatrix, but axes that are orthogonal and of one length, whatever it is, are accepted.
ScaledPose RigidFromScaledMatrix(Eigen::Matrix4d matrix, std::string_view where);

// A pose matrix from JSON: 4 or 3 lists of 4 numbers, or 16 or 12 numbers row by row. Throws
// InputError where the shape is another one or an entry is no number.
Eigen::Matrix4d PoseMatrixFromJson(const nlohmann::json& value, std::string_view where);

// Convert the axes of a camera, from OpenGL (looks along -z, y up) to OpenCV (looks along +z, y
// down) and back; x points right in both.
Eigen::Isometry3d WorldFromOpenCVCamera(const Eigen::Isometry3d& world_from_opengl_camera);
Eigen::Isometry3d WorldFromOpenGLCamera(const Eigen::Isometry3d& world_from_opencv_camera);

}  // namespace nerf
