#include "nerf/image/mask.h"

#include <algorithm>

#include "nerf/base/input_error.h"
#include "nerf/image/image_io.h"

namespace nerf {

Image ReadMask(const std::filesystem::path& path, int width, int height, bool upright_by_exif) {
  const Image file = ReadImage(path, upright_by_exif);
  if (file.width != width || file.height != height) {
    throw InputError("{}: is {}x{} pixels, but its photograph is {}x{}; give a mask of that size",
                     path.string(), file.width, file.height, width, height);
  }
  Image mask(width, height, 1, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    const float* const rgb = &file.pixels[i * file.channels];
    mask.pixels[i] = std::max({rgb[0], rgb[1], rgb[2]}) > 0 ? 1.0f : 0.0f;
  }
  return mask;
}

std::vector<std::uint32_t> UnmaskedPixels(const Image& mask, int factor) {
  const Image unmasked_share = Downscale(mask, factor);
  std::vector<std::uint32_t> unmasked;
  for (std::size_t i = 0; i < unmasked_share.pixels.size(); ++i) {
    // Not 1, since the mean of many ones may be rounded.
    if (unmasked_share.pixels[i] > 0.9999f) unmasked.push_back(static_cast<std::uint32_t>(i));
  }
  return unmasked;
}

Image WithMask(const Image& photograph, const Image& mask) {
  Image out(photograph.width, photograph.height, 4, photograph.encoding);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    const float* const from = &photograph.pixels[i * photograph.channels];
    std::copy_n(from, 3, &out.pixels[4 * i]);
    out.pixels[4 * i + 3] = mask.pixels[i] * (photograph.channels == 4 ? from[3] : 1.0f);
  }
  return out;
}

}  // namespace nerf
