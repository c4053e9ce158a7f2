#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "nerf/image/image.h"

namespace nerf {

// What black pixels of a mask mean: they do not count, or nothing stands there.
enum class MaskMeaning { kIgnore, kEmpty };

// Which part of each pixel a mask leaves: 0 where it is black, 1 elsewhere.
//   width, height  of the photograph, which the mask must have
//   upright_by_exif  turn it as the photograph is turned
// Throws InputError naming the file when it is missing, no image, or of another size.
Image ReadMask(const std::filesystem::path& path, int width, int height, bool upright_by_exif);

// The pixels of the downscaled photograph no part of which is masked out, y * width + x, rising.
std::vector<std::uint32_t> WholePixels(const Image& mask, int factor);

// The photograph with the mask as its alpha, or as a part of the alpha that it has.
Image WithMask(const Image& photograph, const Image& mask);

}  // namespace nerf
