#pragma once

#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// The exposures of a capture from EXIF.
struct ExifStops {
  // Exposure of each photograph relative to their mean, log2 of light. Empty where a photograph has
  // none or contradicts itself, since exposures that are partly known cannot be compared.
  std::vector<double> stops;
  std::string contradiction;  // a message that names the file, or empty
};

ExifStops ReadExifStops(const PosedImages& posed);

}  // namespace nerf
