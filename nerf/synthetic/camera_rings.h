#pragma once

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/sample_options.h"

namespace nerf::synthetic {

// The cameras of a capture, as a person walks round a subject: rings of views about 3 units from
// the origin at different heights, all looking near the origin, none quite regular. Views are
// spread evenly over the rings; 36 of them have neighbours about 22 degrees apart, which match
// well. Where the occasion is footprint, every other view is four times as far.
//   returns  one pinhole camera, options.views images named view_000.png, ... with poses and no
//            pixels (an empty path), in the order of the walk
// The same options give the same cameras on every machine. Throws InputError (Check()).
PosedImages CameraRings(const SampleOptions& options);

}  // namespace nerf::synthetic
