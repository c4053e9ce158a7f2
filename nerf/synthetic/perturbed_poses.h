#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf::synthetic {

// A capture with slightly wrong poses: each camera is rotated about its own centre by 0.4 degrees
// and moved by 0.012 scene units, standard deviations along each axis. Held-out cameras (IsHeldOut)
// keep their poses. The similarity of the world that fits all errors best (least squares, in units
// of the standard deviations) is removed from them: to move all cameras together is no error.
//   posed    true poses
//   returns  the same with perturbed poses; points and the pixels of their tracks are unchanged,
//            reprojection errors are those of the perturbed poses
PosedImages WithPerturbedPoses(const PosedImages& posed, unsigned seed);

}  // namespace nerf::synthetic
