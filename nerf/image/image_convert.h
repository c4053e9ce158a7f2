#pragma once

#include "nerf/image/image.h"

namespace nerf {

// The image in the given encoding; alpha is not changed. Copies an image that already has it.
Image ToSrgb(const Image& image);
Image ToLinear(const Image& image);

// The image in sRGB, with alpha composited on white in sRGB values, as in the NeRF-synthetic
// protocol.
//   returns  no alpha channel
Image OnWhite(const Image& image);

// The image as read back from an 8-bit file: sRGB, clamped, rounded to multiples of 1/255.
Image Quantized(const Image& image);

// Reduces an image by averaging blocks of factor x factor pixels, in linear light and weighted by
// alpha. Rows and columns at the end that do not fill a block are dropped.
//   returns  the encoding of the input
// Throws InputError when the image is smaller than one block or the factor is below 1.
Image Downscale(const Image& image, int factor);

// The image rotated and mirrored by its EXIF orientation, 1 to 8.
Image TurnedUpright(Image stored, int orientation);

}  // namespace nerf
