#pragma once

#include "nerf/effects/inspection.h"
#include "nerf/image/image.h"

namespace nerf {

// What Inspect found out, to look at, on white. Left: the exposure of each photograph in stops, in
// their order. Right: by how much more than their texture explains (1) points change, against the
// angle from which they are seen: median and quartiles. A side of which nothing is known says so.
//   returns  3 channels, sRGB
Image PictureOf(const Inspection& inspection);

}  // namespace nerf
