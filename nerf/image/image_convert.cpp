#include "nerf/image/image_convert.h"

#include <algorithm>
#include <array>

#include "nerf/base/input_error.h"
#include "nerf/image/srgb.h"

namespace nerf {
namespace {

int NumColors(const Image& image) { return std::min(image.channels, kAlphaChannel); }

template <class Transfer>
Image WithTransfer(const Image& image, ColorEncoding encoding, Transfer transfer) {
  Image result = image;
  if (image.encoding == encoding) return result;
  result.encoding = encoding;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      float* pixel = result.At(x, y);
      for (int c = 0; c < NumColors(image); ++c) pixel[c] = transfer(pixel[c]);
    }
  }
  return result;
}

// Mean of the block whose first pixel is (x0, y0); `image` is linear. Colours are weighted by their
// alpha; where the whole block is transparent, equally.
void AverageBlock(const Image& image, int x0, int y0, int factor, float* mean) {
  std::array<double, 4> weighted{};
  std::array<double, 4> plain{};
  double total_alpha = 0;
  for (int y = y0; y < y0 + factor; ++y) {
    for (int x = x0; x < x0 + factor; ++x) {
      const float* pixel = image.At(x, y);
      const double alpha = image.channels > kAlphaChannel ? pixel[kAlphaChannel] : 1.0;
      total_alpha += alpha;
      for (int c = 0; c < NumColors(image); ++c) {
        weighted[c] += alpha * pixel[c];
        plain[c] += pixel[c];
      }
    }
  }
  const double count = static_cast<double>(factor) * factor;
  for (int c = 0; c < NumColors(image); ++c) {
    mean[c] = static_cast<float>(total_alpha > 0 ? weighted[c] / total_alpha : plain[c] / count);
  }
  if (image.channels > kAlphaChannel) mean[kAlphaChannel] = static_cast<float>(total_alpha / count);
}

}  // namespace

Image ToSrgb(const Image& image) {
  return WithTransfer(image, ColorEncoding::kSrgb, SrgbFromLinear);
}

Image ToLinear(const Image& image) {
  return WithTransfer(image, ColorEncoding::kLinear, LinearFromSrgb);
}

Image OnWhite(const Image& image) {
  Image source = ToSrgb(image);
  if (image.channels <= kAlphaChannel) return source;
  Image result(image.width, image.height, kAlphaChannel);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* from = source.At(x, y);
      float* to = result.At(x, y);
      for (int c = 0; c < kAlphaChannel; ++c)
        to[c] = from[c] * from[kAlphaChannel] + (1 - from[kAlphaChannel]);
    }
  }
  return result;
}

Image Quantized(const Image& image) {
  Image result = ToSrgb(image);
  for (float& value : result.pixels) value = static_cast<float>(ByteFromSrgb(value)) / 255.0f;
  return result;
}

Image Downscale(const Image& image, int factor) {
  if (factor < 1) throw InputError("downscale factor {}: give 1 or more", factor);
  if (image.width < factor || image.height < factor) {
    throw InputError("downscale factor {}: too large for an image of {} x {} pixels", factor,
                     image.width, image.height);
  }
  if (factor == 1) return image;
  const Image linear = ToLinear(image);
  Image small(image.width / factor, image.height / factor, image.channels, ColorEncoding::kLinear);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      AverageBlock(linear, x * factor, y * factor, factor, small.At(x, y));
    }
  }
  return image.encoding == ColorEncoding::kSrgb ? ToSrgb(small) : small;
}

// Not ImageBufAlgo::reorient, which in OpenImageIO 2.4 handles orientation 5 as 7.
Image TurnedUpright(Image stored, int orientation) {
  if (orientation == 1) return stored;
  const bool transposed = orientation >= 5;
  const bool flip_x = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool flip_y = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  Image upright(transposed ? stored.height : stored.width,
                transposed ? stored.width : stored.height, stored.channels, stored.encoding);
  for (int y = 0; y < upright.height; ++y) {
    for (int x = 0; x < upright.width; ++x) {
      const int column = transposed ? y : x;
      const int row = transposed ? x : y;
      const float* from = stored.At(flip_x ? stored.width - 1 - column : column,
                                    flip_y ? stored.height - 1 - row : row);
      std::copy_n(from, stored.channels, upright.At(x, y));
    }
  }
  return upright;
}

}  // namespace nerf
