#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string_view>

namespace nerf {

// The rigid motion of a 4x4 matrix from a file, with R replaced by the nearest rotation.
//   matrix  [R t; 0 0 0 1], R orthonormal within 1e-3 and right-handed
//   where   the beginning of error messages: "transforms.json: frames[3].transform_matrix"
// Throws InputError when an entry is not finite, R is no rotation, or the last row differs.
Eigen::Isometry3d RigidFromMatrix(const Eigen::Matrix4d& matrix, std::string_view where);

// Convert the axes of a camera, from OpenGL (looks along -z, y up) to OpenCV (looks along +z, y
// down) and back; x points right in both.
Eigen::Isometry3d WorldFromOpenCVCamera(const Eigen::Isometry3d& world_from_opengl_camera);
Eigen::Isometry3d WorldFromOpenGLCamera(const Eigen::Isometry3d& world_from_opencv_camera);

}  // namespace nerf
