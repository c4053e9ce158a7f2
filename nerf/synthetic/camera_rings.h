#pragma once

#include "nerf/scene/posed_images.h"
#include "nerf/synthetic/sample_options.h"

namespace nerf::synthetic {

// The cameras of a capture, as a person walks around a subject: rings of views at several heights,
// about 3 units from the origin, all looking near the origin, none quite regular. The views are
// spread evenly over the rings; with 36 views, neighbours are about 22 degrees apart, which matches
// well. In Scenario::kAntiAliasing every other view is four times as far away.
//   returns  one pinhole camera; options.views images named view_000.png, ... with poses, without
//            files (empty paths), in the order of the walk
// The same options give the same cameras on every machine. Throws InputError (Check()).
PosedImages CameraRings(const SampleOptions& options);

}  // namespace nerf::synthetic
