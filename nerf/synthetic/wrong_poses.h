#pragma once

#include "nerf/scene/posed_images.h"

namespace nerf::synthetic {

// A capture with poses as they come from somebody who is a little wrong: each camera turned about
// its own centre by 0.4 degrees and moved by 0.012 scene units, standard deviations along each
// axis. Those to judge by (IsToJudgeBy) keep theirs. The similarity of the world that fits all
// errors best (least squares, each in units of its standard deviation) is taken out of them, for to
// move all cameras as one is no error.
//   posed    true poses; points stay where they are, and so do the pixels of their tracks
//   returns  the same with wrong poses, and with the reprojection errors that these give
PosedImages WithWrongPoses(const PosedImages& posed, unsigned seed);

}  // namespace nerf::synthetic
