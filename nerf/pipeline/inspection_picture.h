#pragma once

#include "nerf/effects/inspection.h"
#include "nerf/image/image.h"

namespace nerf {

// The result of Inspect as two plots on white. Left: the exposure of each photograph in stops, in
// their order. Right: how much the colours of points change, relative to what their texture
// explains (1), by viewing angle: median and quartiles. A plot without data says so.
//   returns  3 channels, sRGB
Image PictureOf(const Inspection& inspection);

}  // namespace nerf
