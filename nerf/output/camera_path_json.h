#pragma once

#include <filesystem>
#include <optional>

#include "nerf/output/camera_path.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// Reads nerfstudio's camera_path.json (source: nerfstudio, cameras/camera_paths.py):
//   render_width, render_height   pixels
//   camera_type                   must be "perspective"
//   camera_path                   list of
//     camera_to_world             16 or 12 numbers row by row, or nested 4x4 or 3x4; OpenGL axes
//     fov                         vertical full angle in degrees
//   fps, seconds                  frames per second, or the total length; default 30 fps
// The matrices are in the world frame of the input. `width` and `height` replace the size in the
// file; if only one is given, the aspect ratio is kept. Throws InputError naming file and key.
CameraPath ReadCameraPath(const std::filesystem::path& json, std::optional<int> width = {},
                          std::optional<int> height = {});

// Reads one pose: "transform_matrix" or "camera_to_world" as above, OpenGL axes. The lens is given
// by "fov" (vertical, degrees) or by the keys of a transforms.json (fl_x, camera_angle_x, k1, ...),
// at w x h, by default the size of the first camera of `images`; without such keys it is the lens
// of that camera. Throws InputError naming file and key.
PathPose ReadPose(const std::filesystem::path& json, const PosedImages& images);

}  // namespace nerf
