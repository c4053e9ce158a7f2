#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string_view>

namespace nerf {

// The rigid motion that a 4x4 matrix of a file means: its rotation replaced by the nearest one.
//   matrix  [R t; 0 0 0 1], R orthonormal within 1e-3 and right-handed
//   where   "transforms.json: frames[3].transform_matrix": begins the message
// Throws InputError when an entry is not finite, R is no rotation, or the last row is another.
Eigen::Isometry3d RigidFromMatrix(const Eigen::Matrix4d& matrix, std::string_view where);

// Camera axes: OpenGL looks along -z with y up, OpenCV along +z with y down. Both look right along
// x. The two are each other's inverse.
Eigen::Isometry3d WorldFromOpenCVCamera(const Eigen::Isometry3d& world_from_opengl_camera);
Eigen::Isometry3d WorldFromOpenGLCamera(const Eigen::Isometry3d& world_from_opencv_camera);

}  // namespace nerf
