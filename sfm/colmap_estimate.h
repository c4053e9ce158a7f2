#pragma once

#include "sfm/colmap_options.h"

namespace nerf::sfm {

// How long PosesFromPhotos takes, roughly, seconds: within a factor of two on processors of about
// 2.6 GHz (Zen 4).
//   longest_side  of a photograph, pixels
double EstimatePoseSeconds(int photographs, int longest_side, const ColmapOptions& options,
                           int threads);

// The same for FindSparsePoints.
double EstimatePointSeconds(int photographs, int longest_side, const ColmapOptions& options,
                            int threads);

}  // namespace nerf::sfm
