#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "nerf/light/lights.h"

namespace nerf {

// The lights of a capture, in the order of its images or by their names.
struct LightList {
  std::vector<DirectionalLight> lights;
  std::vector<std::string> images;  // of each light, without folders; empty: in order
  bool has_intensities = false;     // some light has one
};

// Reads the lights of a capture, one per line:
//   x y z              direction from the subject to the light, of any length > 0
//   x y z i            with an intensity
//   x y z r g b        with an intensity for each channel
//   NAME x y z ...     of the image of that name (the .lp files of RTI); NAME begins with a letter,
//                      or ends with the extension of an image, and then may have blanks and folders
// The first line may be a single number, how many lights follow (as in the data sets of the
// universities of Washington and Harvard). Empty lines and text after a # are ignored. Beside a
// file light_directions.txt, light_intensities.txt has the intensities, "r g b" or "i" a line (as
// in DiLiGenT, Shi et al. 2019).
// Axes: x right, y up, z towards the camera, as seen in the picture. Under a light of intensity 1,
// the default, a white diffuse surface that faces it has the value 1; its irradiance is pi.
// Throws InputError naming the file and the line.
LightList ReadLights(const std::filesystem::path& file);

// Writes such a file; intensities of 1 are omitted. Throws InputError.
void WriteLights(const std::filesystem::path& file, std::span<const DirectionalLight> lights);

}  // namespace nerf
