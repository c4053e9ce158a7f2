#pragma once

#include "nerf/image/image.h"
#include "nerf/image/image_convert.h"  // OnWhite, Quantized

namespace nerf {

// Both metrics compare two images as they would be saved: composited on white where they have
// alpha, converted to sRGB, clamped and rounded to 8 bits. Both throw InputError where the two
// differ in size.

// Peak signal-to-noise ratio in dB over all pixels and colours, peak 1. Equal images: +infinity.
double Psnr(const Image& a, const Image& b);

// Structural similarity, mean over pixels and colours; 1 for equal images.
// Source: Wang et al. 2004: Gaussian window of 11 x 11, sigma 1.5, K1 = 0.01, K2 = 0.03, range 1;
// population covariance, only windows entirely inside the image.
// Throws InputError where an image is smaller than the window.
double Ssim(const Image& a, const Image& b);

}  // namespace nerf
