#include "sfm/colmap_options.h"

#include "nerf/base/input_error.h"
#include "nerf/scene/camera_models.h"

namespace nerf::sfm {

void ColmapOptions::Check() const {
  if (matcher != "auto" && matcher != "exhaustive" && matcher != "sequential" &&
      matcher != "guided") {
    throw InputError("matcher: '{}' is unknown; use auto, exhaustive, sequential or guided",
                     matcher);
  }
  if (!CameraModelFromName(camera_model)) {
    throw InputError(
        "camera model: '{}' is unknown; use OPENCV for most lenses, OPENCV_FISHEYE for wide ones, "
        "or "
        "another of COLMAP's models",
        camera_model);
  }
  if (max_image_size < 200) {
    throw InputError("max image size: {} is too small for features; give 200 pixels or more",
                     max_image_size);
  }
  if (max_num_features < 200) {
    throw InputError("max features: {} is too few to match; give 200 or more", max_num_features);
  }
  if (threads < 0) throw InputError("threads: {}; give 1 or more, or 0 for all cores", threads);
}

}  // namespace nerf::sfm
