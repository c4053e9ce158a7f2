#pragma once

#include <filesystem>

#include "nerf/data/image.h"

namespace nerf::appearance {

// What the numbers of an image file mean.
enum class InputEncoding {
  kAuto,    // 8-bit integers: sRGB; more bits, floats and camera raw: linear
  kSrgb,    // integers: sRGB; floats: linear all the same
  kLinear,  // proportional to light
};

// Whether a file's numbers are taken as linear by kAuto. False too where it cannot be opened.
bool StoresLinearLight(const std::filesystem::path& file);

// Reads an image as linear light, 3 channels; alpha is dropped. Integers are scaled to [0,1].
// Throws sfm::InputError naming the file.
Image ReadLinearImage(const std::filesystem::path& file, InputEncoding encoding);

}  // namespace nerf::appearance
