#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// One picture to render, in the frame and units of the input.
struct PathPose {
  Eigen::Isometry3d world_from_camera;  // OpenCV axes
  Camera camera;
  double seconds = 0;  // since the start of the film
};

struct CameraPath {
  std::vector<PathPose> poses;
  double frames_per_second = 30;
};

// Paths derived from the cameras of the photographs. All poses have the size, focal length and
// principal point of the first camera, without lens distortion.
// All throw InputError if there are no images or `frames` is outside 1 .. 100,000.

// A closed circle around the point that the cameras look at (NormalizeScene), about their mean up
// direction, at their mean height and mean distance from that axis, starting at the first camera.
// If the cameras look outwards, as in a room, so does the path.
CameraPath OrbitPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                     int frames);

// A closed spiral of two turns around the mean pose, moving forward and back once, and looking at
// the focus: the point that the cameras look at (NormalizeScene), projected onto the mean viewing
// direction. The radii are the 90th percentiles of the offsets of the cameras from the mean pose.
// Source: Mildenhall et al. 2019 (LLFF), render_path_spiral in load_llff.py.
CameraPath SpiralPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                      int frames);

// A smooth path through the cameras in the order of their names, without the held-out ones if the
// input lists them: Catmull-Rom splines through the centres, spherical quadrangle interpolation of
// the rotations (Shoemake 1987). With frames = 1 + m (cameras - 1) every m-th frame is at a camera.
CameraPath TrainingPath(const PosedImages& images, int frames);

// The pose of a camera at `center` that looks at `target`; OpenCV axes. If the viewing direction is
// parallel to `up`, the rotation about it is arbitrary.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& center, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up);

}  // namespace nerf
