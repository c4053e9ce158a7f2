#pragma once

#include "nerf/image/image.h"

namespace nerf {

// The same picture in the other encoding; alpha stays. An image that is there already is copied.
Image ToSrgb(const Image& image);
Image ToLinear(const Image& image);

// An image without alpha, in sRGB: one with alpha is laid over white, mixing sRGB values, as the
// NeRF-synthetic protocol does.
Image OnWhite(const Image& image);

// The image as an 8-bit file would give it back: sRGB, clamped, rounded to multiples of 1/255.
Image Quantized(const Image& image);

// Area average over blocks of factor x factor whole pixels, in linear light, alpha-weighted; edge
// rows and columns that do not fill a block are dropped. Same encoding as the input.
// Throws InputError when the image is smaller than one block or the factor below 1.
Image Downscale(const Image& image, int factor);

}  // namespace nerf
