#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "nerf/image/image.h"
#include "nerf/image/image_size.h"

namespace nerf {

// What the black pixels of a mask mean: the photograph is invalid there (say, a passer-by), or the
// scene is empty there.
enum class MaskMeaning { kIgnore, kEmpty };

// How much of each pixel a mask keeps, in [0,1], 1 channel: its alpha if that varies, whatever its
// colours, else its brightest channel; relative to the largest value, since the masks of some
// programs are labels 0 and 1 of 255. Throws InputError as ReadImage does.
Image ReadMaskCoverage(const std::filesystem::path& path, bool upright_by_exif);

// A photograph as far as its mask depends on it.
struct MaskedPhotograph {
  int width = 0, height = 0;     // after rotation
  int orientation = 1;           // EXIF, of its file
  bool upright_by_exif = false;  // whether it is rotated by it
};

// Reads a mask: 0 where its coverage is 0 (in a JPEG, whose black is not exact, at most a half), 1
// elsewhere. The mask may be painted on the photograph as stored or upright, and may be
// a scaled copy of it.
// Throws InputError naming the file when it is missing, is no image, or has another size.
Image ReadMask(const std::filesystem::path& path, const MaskedPhotograph& photograph);

// Whether ReadMask accepts a mask of this size.
bool MaskFits(const ImageSize& mask, const MaskedPhotograph& photograph);

// The pixels of the downscaled photograph of which no part is masked out: y * width + x, ascending.
std::vector<std::uint32_t> UnmaskedPixels(const Image& mask, int factor);

// The photograph with its alpha (1 where it has none) multiplied by the mask.
Image WithMask(const Image& photograph, const Image& mask);

}  // namespace nerf
