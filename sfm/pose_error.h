#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// How far poses are from the true ones, after the similarity that aligns the camera centres best
// (Umeyama 1991), since structure from motion knows neither frame nor unit.
struct PoseErrors {
  int images = 0;                                    // that both have
  double rotation_median = 0, rotation_largest = 0;  // degrees
  double position_median = 0, position_largest = 0;  // of the cameras' mean distance from their
                                                     // centre
};

// Compares the images of the same file name. Throws InputError naming the truth where fewer than
// four have one.
PoseErrors ComparePoses(const PosedImages& found, const PosedImages& truth);
// The same for images of the same name, folders included.
PoseErrors ComparePosesByName(const PosedImages& found, const PosedImages& truth);

}  // namespace nerf::sfm
