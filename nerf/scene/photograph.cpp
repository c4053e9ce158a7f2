#include "nerf/scene/photograph.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "nerf/base/input_error.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_files.h"
#include "nerf/image/image_io.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/lens_coverage.h"

namespace nerf {
namespace {

// A mask that is 0 where a photograph is clipped (1 in some channel) and 1 elsewhere.
Image UnclippedMask(const Image& photograph) {
  Image unclipped(photograph.width, photograph.height, 1, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < unclipped.pixels.size(); ++i) {
    const float* const rgb = &photograph.pixels[i * photograph.channels];
    const bool transparent = photograph.channels == 4 && rgb[3] == 0;
    unclipped.pixels[i] = transparent || std::max({rgb[0], rgb[1], rgb[2]}) < 1 ? 1.0f : 0.0f;
  }
  return unclipped;
}

// The intersection of two ascending lists, of which an empty `a` stands for all pixels.
std::vector<std::uint32_t> Intersection(const std::vector<std::uint32_t>& a,
                                        const std::vector<std::uint32_t>& b) {
  if (a.empty()) return b;
  std::vector<std::uint32_t> both;
  std::ranges::set_intersection(a, b, std::back_inserter(both));
  return both;
}

// Applies a mask in full resolution to pixels in full resolution.
void ApplyMask(const Image& mask, const PosedImage& image, const PhotographOptions& options,
               Photograph& photograph) {
  if (*options.masks == MaskMeaning::kEmpty) {
    photograph.pixels = WithMask(photograph.pixels, mask);
    return;
  }
  photograph.valid_pixels = UnmaskedPixels(mask, options.downscale);
  if (photograph.valid_pixels.empty()) {
    throw InputError("{}: masks out the whole photograph; black is what it masks out",
                     image.mask.string());
  }
}

// Converts pixels in full resolution to linear and marks the clipped ones as invalid.
void Linearize(const PosedImage& image, const Camera& camera, int downscale,
               Photograph& photograph) {
  photograph.valid_pixels = Intersection(
      photograph.valid_pixels, UnmaskedPixels(UnclippedMask(photograph.pixels), downscale));
  if (photograph.valid_pixels.empty()) {
    throw InputError(
        "{}: every pixel is clipped to white, so none can be used beside linear images; remove it, "
        "or give an EXR of it",
        image.path.string());
  }
  if (std::ssize(photograph.valid_pixels) == PixelCount(Downscaled(camera, downscale))) {
    photograph.valid_pixels.clear();  // all
  }
  photograph.pixels = ToLinear(photograph.pixels);
}

// Marks pixels as invalid that the lens does not cover.
void LeaveToLens(const PosedImage& image, const Camera& downscaled, Photograph& photograph) {
  const auto covered = PixelsInLens(downscaled);
  if (!covered) return;
  photograph.valid_pixels = Intersection(photograph.valid_pixels, *covered);
  if (photograph.valid_pixels.empty()) {
    throw InputError(
        "{}: its lens covers no pixel that can be used; correct the parameters of its camera, or "
        "its mask, or remove the photograph",
        image.path.string());
  }
}

}  // namespace

Photograph LoadPhotograph(const PosedImages& posed, const PosedImage& image,
                          const PhotographOptions& options) {
  Photograph photograph = {ReadImage(image.path, image.upright_by_exif), {}};
  Image& pixels = photograph.pixels;
  const Camera& camera = posed.cameras[image.camera];
  if (pixels.width != camera.width || pixels.height != camera.height) {
    throw InputError(
        "{}: is {}x{} pixels, but its camera in {} is {}x{}; give the photographs from which the "
        "poses were computed",
        image.path.string(), pixels.width, pixels.height, posed.source.string(), camera.width,
        camera.height);
  }
  if (options.masks && !image.mask.empty()) {
    ApplyMask(ReadMaskOf(image, pixels), image, options, photograph);
  }
  if (options.linear && pixels.encoding == ColorEncoding::kSrgb) {
    Linearize(image, camera, options.downscale, photograph);
  }
  LeaveToLens(image, Downscaled(camera, options.downscale), photograph);
  pixels = Downscale(pixels, options.downscale);
  return photograph;
}

Image ReadMaskOf(const PosedImage& image, const Image& pixels) {
  const auto stored = ReadImageSize(image.path);
  return ReadMask(image.mask, {pixels.width, pixels.height, stored ? stored->orientation : 1,
                               image.upright_by_exif});
}

void CheckMasks(const PosedImages& posed) {
  for (const PosedImage& image : posed.images) {
    if (image.mask.empty()) continue;
    const auto mask = ReadImageSize(image.mask), photograph = ReadImageSize(image.path);
    if (!mask) throw InputError("{}: cannot be read as an image", image.mask.string());
    if (!photograph) continue;  // it is skipped later
    const ImageSize size = image.upright_by_exif ? Upright(*photograph) : *photograph;
    if (MaskFits(*mask,
                 {size.width, size.height, photograph->orientation, image.upright_by_exif})) {
      continue;
    }
    throw InputError("{}: is {}x{} pixels, but its photograph is {}x{}; give a mask of that size",
                     image.mask.string(), mask->width, mask->height, size.width, size.height);
  }
}

int CountPhotographsToLinearize(const PosedImages& posed) {
  int display_referred = 0, linear = 0;
  for (const PosedImage& image : posed.images) {
    if (image.split == Split::kTest) continue;
    const std::optional<ColorEncoding> encoding = ReadColorEncoding(image.path);
    if (encoding) ++(*encoding == ColorEncoding::kLinear ? linear : display_referred);
  }
  return linear > 0 ? display_referred : 0;
}

}  // namespace nerf
