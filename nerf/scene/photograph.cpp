#include "nerf/scene/photograph.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "nerf/base/input_error.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_files.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

// 1 where a photograph is not white to the end of its scale in any channel, 0 where it is.
Image NotWhite(const Image& photograph) {
  Image below(photograph.width, photograph.height, 1, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < below.pixels.size(); ++i) {
    const float* const rgb = &photograph.pixels[i * photograph.channels];
    const bool transparent = photograph.channels == 4 && rgb[3] == 0;
    below.pixels[i] = transparent || std::max({rgb[0], rgb[1], rgb[2]}) < 1 ? 1.0f : 0.0f;
  }
  return below;
}

// The pixels that are in both; all are in one that is empty.
std::vector<std::uint32_t> Both(const std::vector<std::uint32_t>& some,
                                const std::vector<std::uint32_t>& others) {
  if (some.empty()) return others;
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(some, others, std::back_inserter(both));
  return both;
}

}  // namespace

Photograph LoadPhotograph(const PosedImages& posed, const PosedImage& image,
                          const PhotographOptions& options) {
  Photograph photograph = {ReadImage(image.path, image.upright_by_exif), {}};
  Image& pixels = photograph.pixels;
  const Camera& camera = posed.cameras[image.camera];
  if (pixels.width != camera.width || pixels.height != camera.height) {
    throw InputError(
        "{}: is {}x{} pixels, but its camera in {} is {}x{}; give the photographs that the poses "
        "were made from",
        image.path.string(), pixels.width, pixels.height, posed.source.string(), camera.width,
        camera.height);
  }
  if (options.masks && !image.mask.empty()) {
    const Image mask = ReadMask(image.mask, pixels.width, pixels.height, image.upright_by_exif);
    if (*options.masks == MaskMeaning::kEmpty) {
      pixels = WithMask(pixels, mask);
    } else {
      photograph.whole = WholePixels(mask, options.downscale);
      if (photograph.whole.empty()) {
        throw InputError("{}: masks out the whole photograph; black is what it masks out",
                         image.mask.string());
      }
    }
  }
  if (options.linear && pixels.encoding == ColorEncoding::kSrgb) {
    photograph.whole = Both(photograph.whole, WholePixels(NotWhite(pixels), options.downscale));
    if (photograph.whole.empty()) {
      throw InputError(
          "{}: is white to the end of its scale and says nothing beside linear "
          "images",
          image.path.string());
    }
    const Camera small = Downscaled(camera, options.downscale);
    if (photograph.whole.size() == static_cast<std::size_t>(small.width) * small.height) {
      photograph.whole.clear();  // all
    }
    pixels = ToLinear(pixels);
  }
  pixels = Downscale(pixels, options.downscale);
  return photograph;
}

void CheckMasks(const PosedImages& posed) {
  for (const PosedImage& image : posed.images) {
    if (image.mask.empty()) continue;
    const auto mask = ReadImageSize(image.mask), photograph = ReadImageSize(image.path);
    if (!mask) throw InputError("{}: cannot be read as an image", image.mask.string());
    if (!photograph || (mask->width == photograph->width && mask->height == photograph->height)) {
      continue;  // a photograph that cannot be read is left out later
    }
    throw InputError("{}: is {}x{} pixels, but its photograph is {}x{}; give a mask of that size",
                     image.mask.string(), mask->width, mask->height, photograph->width,
                     photograph->height);
  }
}

int DisplayReferredAmongLinear(const PosedImages& posed) {
  int display = 0, linear = 0;
  for (const PosedImage& image : posed.images) {
    if (image.split == Split::kTest) continue;
    const std::optional<ColorEncoding> encoding = ReadColorEncoding(image.path);
    if (encoding) ++(*encoding == ColorEncoding::kLinear ? linear : display);
  }
  return linear > 0 ? display : 0;
}

}  // namespace nerf
