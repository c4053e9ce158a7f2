#pragma once

#include <filesystem>

#include "nerf/image/image.h"

namespace nerf {

// How the values of an image file are interpreted. Camera raw is always linear: the sRGB curve that
// its decoder applies is inverted.
enum class InputEncoding {
  kAuto,    // 8-bit integers: sRGB; more bits and floats: linear
  kSrgb,    // integers: sRGB; floats: linear
  kLinear,  // proportional to light
};

// Whether kAuto takes a file as linear: more than 8 bits, floats, or camera raw. False where it
// cannot be opened.
bool StoresLinearLight(const std::filesystem::path& file);

// Whether a file stores integers, which clip bright light, and not floats. True where it cannot be
// opened.
bool StoresIntegers(const std::filesystem::path& file);

// Reads an image as linear light, 3 channels. What is stored is the light: alpha is dropped, and
// colours that are premultiplied with it (EXR), such as those of a glow with alpha 0, stay as they
// are. Integers are scaled to [0,1].
// Throws InputError naming the file.
Image ReadLinearImage(const std::filesystem::path& file, InputEncoding encoding);

}  // namespace nerf
