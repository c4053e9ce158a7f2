#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "nerf/light/lights.h"

namespace nerf {

// Reads the lights of a capture, a line each, in the order of its images:
//   x y z              direction from the subject to the light, of any length > 0
//   x y z i            with an intensity
//   x y z r g b        with an intensity for each channel
// A first line of one number, how many lights follow, may stand before them (as in the data sets of
// Washington and Harvard); empty lines and what follows a # are skipped.
// Axes: x to the right of the picture, y up, z towards the camera. An intensity of 1 (where none is
// given) is the light in which a white matt surface that faces it is 1: an irradiance of pi.
// Throws InputError naming file and line.
std::vector<DirectionalLight> ReadLights(const std::filesystem::path& file);

// Writes such a file, with intensities where they are not 1. Throws InputError.
void WriteLights(const std::filesystem::path& file, std::span<const DirectionalLight> lights);

}  // namespace nerf
