#pragma once

#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// What the cameras have written of their exposures, for the whole capture.
struct ExifStops {
  // Of each photograph against their mean, log2 of light. Empty where one has none, or contradicts
  // itself: exposures that are known in part cannot be compared.
  std::vector<double> stops;
  std::string contradiction;  // one line that names the file, or empty
};

ExifStops ReadExifStops(const PosedImages& posed);

}  // namespace nerf
