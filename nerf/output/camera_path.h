#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// One picture to render. Frame and units are those of the input.
struct PathPose {
  Eigen::Isometry3d world_from_camera;  // OpenCV axes
  Camera camera;
  double seconds = 0;  // since the start of the film
};

struct CameraPath {
  std::vector<PathPose> poses;
  double frames_per_second = 30;
};

// Paths made up from the cameras of the photographs. Every pose gets the first camera's size, focal
// length and principal point, without its lens distortion.
// All throw InputError where there are no images or `frames` is outside 1 .. 100,000.

// A circle around what the cameras look at (NormalizeScene), about their mean up, at their
// mean height and mean distance from that axis; it starts beside the first camera and closes.
// Cameras that look outwards, as in a room, give a circle that looks outwards.
CameraPath OrbitPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                     int frames);

// Two turns around the mean pose, in and out once, always looking at the focus; it closes. The
// widths are the 90th percentiles of the cameras' offsets from the mean pose.
// Source: Mildenhall et al. 2019 (LLFF), render_path_spiral in load_llff.py. The focus is what the
// cameras look at (NormalizeScene), seen along the mean viewing direction.
CameraPath SpiralPath(const PosedImages& images, const SceneNormalization& normalized_from_world,
                      int frames);

// A smooth path through the cameras in the order of their names, held-out ones left out where the
// input says which: Catmull-Rom splines through the centres, spherical quadrangle interpolation of
// the rotations (Shoemake 1987). With frames = 1 + m (cameras - 1) every m-th frame is a camera.
CameraPath TrainingPath(const PosedImages& images, int frames);

// The camera that stands at `center` and looks at `target`; OpenCV axes. Where the view runs along
// `up`, some direction across it is up instead.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& center, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up);

}  // namespace nerf
