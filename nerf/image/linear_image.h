#pragma once

#include <filesystem>

#include "nerf/image/image.h"

namespace nerf {

// What the numbers of an image file mean.
enum class InputEncoding {
  kAuto,    // 8-bit integers: sRGB; more bits and floats: linear
  kSrgb,    // integers: sRGB; floats: linear all the same
  kLinear,  // proportional to light
};
// Camera raw is what the sensor counted, so linear whatever is said of it: the sRGB curve that its
// decoder lays over it is undone.

// Whether a file holds linear light by itself, as kAuto takes it: more than 8 bits, floats, camera
// raw. False too where it cannot be opened.
bool StoresLinearLight(const std::filesystem::path& file);

// Whether a file's numbers have a largest one, at which what is brighter was cut off: integers, not
// floats. True too where it cannot be opened.
bool StoresIntegers(const std::filesystem::path& file);

// Reads an image as linear light, 3 channels; alpha is dropped. Integers are scaled to [0,1].
// Throws InputError naming the file.
Image ReadLinearImage(const std::filesystem::path& file, InputEncoding encoding);

}  // namespace nerf
