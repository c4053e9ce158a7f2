#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "nerf/light/lights.h"

namespace nerf {

// Reads the lights of a capture, one per line, in the order of its images:
//   x y z              direction from the subject to the light, of any length > 0
//   x y z i            with an intensity
//   x y z r g b        with an intensity for each channel
// The first line may be a single number, how many lights follow (as in the data sets of the
// universities of Washington and Harvard). Empty lines and text after a # are ignored.
// Axes: x right, y up, z towards the camera, as seen in the picture. Under a light of intensity 1,
// the default, a white diffuse surface that faces it has the value 1; its irradiance is pi.
// Throws InputError naming the file and the line.
std::vector<DirectionalLight> ReadLights(const std::filesystem::path& file);

// Writes such a file; intensities of 1 are omitted. Throws InputError.
void WriteLights(const std::filesystem::path& file, std::span<const DirectionalLight> lights);

}  // namespace nerf
