#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// What the black pixels of a mask mean: the photograph is invalid there (say, a passer-by), or the
// scene is empty there.
enum class MaskMeaning { kIgnore, kEmpty };

// Reads a mask: 0 where the file is black, 1 elsewhere.
//   width, height    of its photograph
//   upright_by_exif  rotate by the EXIF orientation, as the photograph is
// Throws InputError naming the file when it is missing, is no image, or has another size.
Image ReadMask(const std::filesystem::path& path, int width, int height, bool upright_by_exif);

// The pixels of the downscaled photograph of which no part is masked out: y * width + x, ascending.
std::vector<std::uint32_t> UnmaskedPixels(const Image& mask, int factor);

// The photograph with its alpha (1 where it has none) multiplied by the mask.
Image WithMask(const Image& photograph, const Image& mask);

}  // namespace nerf
