#pragma once

#include <cstddef>
#include <vector>

namespace nerf {

// How pixel values relate to light: display-referred with the sRGB transfer function, as
// photographs are, or proportional to radiance, as EXR and HDR files are.
enum class ColorEncoding { kSrgb, kLinear };

inline constexpr int kAlphaChannel = 3;  // where there is one

// An image in memory: `height` rows of `width` pixels of `channels` floats, top row first.
// Colour is in [0,1] for sRGB and unbounded for linear images. Channel 3, where present, is alpha
// in [0,1]; colour is not premultiplied ("straight").
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  ColorEncoding encoding = ColorEncoding::kSrgb;
  std::vector<float> pixels;

  Image() = default;
  Image(int width_, int height_, int channels_, ColorEncoding encoding_ = ColorEncoding::kSrgb)
      : width(width_),
        height(height_),
        channels(channels_),
        encoding(encoding_),
        pixels(static_cast<std::size_t>(width_) * height_ * channels_, 0.0f) {}

  float* At(int x, int y) { return pixels.data() + Offset(x, y); }
  const float* At(int x, int y) const { return pixels.data() + Offset(x, y); }

 private:
  std::size_t Offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

}  // namespace nerf
