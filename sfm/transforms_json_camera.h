#pragma once

#include <nlohmann/json.hpp>

#include "nerf/base/json_fields.h"
#include "nerf/image/image_files.h"
#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// The lens of one frame of a transforms.json; a key of the frame overrides the same key of the
// file. Understands
//   w, h                        image size in pixels; `stored` where absent
//   fl_x, fl_y                  focal lengths in pixels
//   x_fov, y_fov                full angle in degrees (instant-ngp)
//   camera_angle_x, ..._y       full angle in radians (Blender, instant-ngp)
//   cx, cy                      principal point in pixels; the image centre where absent
//   k1..k6, p1, p2              distortion as OpenCV defines it
//   camera_model, is_fisheye    OPENCV, OPENCV_FISHEYE, ... (nerfstudio), or true (instant-ngp)
//   camera_params               with a camera_model of COLMAP: its parameters, in its order (ours)
// The model is the simplest equivalent one. Throws InputError naming file, frame and key when
// one has the wrong type or range, the focal length is missing, or the lens is of another kind.
Camera CameraFromJson(const JsonFields& frame, const JsonFields& file, const ImageSize& stored);

// The same keys for a camera, in nerfstudio's conventions. Models that they cannot express exactly
// are written as camera_model with camera_params.
nlohmann::json JsonFromCamera(const Camera& camera);

}  // namespace nerf::sfm
