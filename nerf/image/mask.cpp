#include "nerf/image/mask.h"

#include <algorithm>
#include <cstdint>

#include "nerf/base/input_error.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/image/oiio_files.h"

namespace nerf {
namespace {

float Brightest(const float* rgb) { return std::max({rgb[0], rgb[1], rgb[2]}); }

bool IsJpeg(const std::filesystem::path& file) {
  const auto input = OpenImageInput(file);
  return input && input->format_name() == std::string("jpeg");
}

bool AlphaVaries(const Image& image) {
  if (image.channels <= kAlphaChannel) return false;
  for (std::size_t i = kAlphaChannel; i < image.pixels.size(); i += image.channels) {
    if (image.pixels[i] != image.pixels[kAlphaChannel]) return true;
  }
  return false;
}

// The alpha of a mask if it varies, else its brightest channel, relative to the largest value.
Image Coverage(const Image& file) {
  const bool by_alpha = AlphaVaries(file);
  Image coverage(file.width, file.height, 1, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < coverage.pixels.size(); ++i) {
    const float* const pixel = &file.pixels[i * file.channels];
    coverage.pixels[i] = by_alpha ? pixel[kAlphaChannel] : Brightest(pixel);
  }
  const float largest = *std::ranges::max_element(coverage.pixels);
  if (largest > 0) {
    for (float& value : coverage.pixels) value /= largest;
  }
  return coverage;
}

// A mask in another size: a pixel is masked out if any part of it is.
Image Resized(const Image& mask, int width, int height) {
  if (mask.width == width && mask.height == height) return mask;
  // The first and the last of `from` pixels that overlap pixel i of `to`.
  const auto first = [](int i, int from, int to) {
    return static_cast<int>(std::int64_t{i} * from / to);
  };
  const auto last = [](int i, int from, int to) {
    return static_cast<int>((std::int64_t{i + 1} * from - 1) / to);
  };
  Image resized(width, height, 1, ColorEncoding::kLinear);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float kept = 1;
      for (int v = first(y, mask.height, height); v <= last(y, mask.height, height); ++v) {
        for (int u = first(x, mask.width, width); u <= last(x, mask.width, width); ++u) {
          kept = std::min(kept, *mask.At(u, v));
        }
      }
      *resized.At(x, y) = kept;
    }
  }
  return resized;
}

ImageSize Turned(const ImageSize& size) { return {size.height, size.width}; }

// The orientation that undoes another one.
int Inverse(int orientation) { return orientation == 6 ? 8 : orientation == 8 ? 6 : orientation; }

}  // namespace

Image ReadMaskCoverage(const std::filesystem::path& path, bool upright_by_exif) {
  return Coverage(ReadImage(path, upright_by_exif));
}

bool MaskFits(const ImageSize& mask, const MaskedPhotograph& photograph) {
  const ImageSize size = {photograph.width, photograph.height};
  const ImageSize as_read = photograph.upright_by_exif ? Upright(mask) : mask;
  return IsScaledCopy(as_read, size) ||
         (photograph.orientation >= 5 && IsScaledCopy(Turned(as_read), size));
}

Image ReadMask(const std::filesystem::path& path, const MaskedPhotograph& photograph) {
  Image file = ReadImage(path, photograph.upright_by_exif);
  const ImageSize size = {photograph.width, photograph.height};
  if (!MaskFits({file.width, file.height}, photograph)) {
    throw InputError("{}: is {}x{} pixels, but its photograph is {}x{}; give a mask of that size",
                     path.string(), file.width, file.height, size.width, size.height);
  }
  if (!IsScaledCopy({file.width, file.height}, size)) {
    file = TurnedUpright(std::move(file), photograph.upright_by_exif
                                              ? photograph.orientation
                                              : Inverse(photograph.orientation));
  }
  Image mask = Coverage(file);
  const float black = IsJpeg(path) ? 0.5f : 0.0f;
  for (float& value : mask.pixels) value = value > black ? 1.0f : 0.0f;
  return Resized(mask, size.width, size.height);
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
