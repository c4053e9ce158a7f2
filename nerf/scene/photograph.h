#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/image/mask.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

struct PhotographOptions {
  int downscale = 1;
  std::optional<MaskMeaning> masks = {};  // nullopt: masks are ignored
  // Whether display-referred photographs are converted to linear. Their clipped pixels (1 in some
  // channel) are then invalid, since their radiance is unknown.
  bool linear = false;
};

// One photograph as training and evaluation use it: upright, downscaled, 3 or 4 channels.
struct Photograph {
  Image pixels;
  std::vector<std::uint32_t> valid_pixels;  // y * width + x, ascending; empty: all
};
// Throws InputError naming the file where it cannot be read, differs in size from its camera, or
// has no valid pixel.
Photograph LoadPhotograph(const PosedImages& posed, const PosedImage& image,
                          const PhotographOptions& options);

// The mask of a photograph as ReadMask returns it.
//   pixels  of the photograph, in full resolution
Image ReadMaskOf(const PosedImage& image, const Image& pixels);

// Throws InputError naming the first mask whose size differs from its photograph's: better before
// an hour of training than after it. Reads file headers only.
void CheckMasks(const PosedImages& posed);

// The number of display-referred photographs in a capture that also has linear ones, else 0.
// Photographs that are held out are not counted. Reads file headers only.
int CountPhotographsToLinearize(const PosedImages& posed);

}  // namespace nerf
