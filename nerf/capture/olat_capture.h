#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/image/linear_image.h"
#include "nerf/light/lights.h"

namespace nerf {

// Photographs of a subject by a fixed camera, one light at a time (OLAT).
struct OlatCapture {
  std::string name;                             // of the subject
  std::filesystem::path folder;                 // as it was given
  std::vector<std::filesystem::path> images;    // all of one size
  std::vector<DirectionalLight> lights;         // for each image
  std::string lights_source;                    // the file or folder of the directions
  std::vector<std::filesystem::path> masks;     // the subject is where all of them are white
  std::optional<std::filesystem::path> chrome;  // folder of a chrome ball under the same lights
  int width = 0;
  int height = 0;
};

// Where the directions of the lights come from.
enum class LightCalibration {
  kAuto,        // lights.txt if there is one, else the chrome ball
  kChromeBall,  // highlights on a chrome ball
  kFile,        // OlatOptions::light_file
};

struct OlatOptions {
  LightCalibration lights = LightCalibration::kAuto;
  std::filesystem::path light_file;  // see light_file.h
  InputEncoding encoding = InputEncoding::kAuto;
};

// Finds a capture in a folder. The images are in the folder itself or in its only sub-folder with
// images, not counting chrome balls and results (normals.exr, relit.exr).
//   - Their order is that of a list, one image per line of which only the file name matters:
//     filenames.txt in the folder (DiLiGenT, Shi et al. 2019), or NAME.txt beside the folder NAME
//     (the data sets of the universities of Washington and Harvard); else by name, with numbers
//     compared by value.
//   - Images with "mask" in their names are masks, unless all have it.
//   - Lights are in lights.txt, light_directions.txt or one .lp file, in the folder of the images
//     or in its parent; so is the folder `chrome` of the ball, with a mask.
//   - Ground truth (Normal_gt.*) is left out.
// Throws InputError if there are no images, several sizes, several subjects, no lights, or not a
// light for each image.
OlatCapture FindOlatCapture(const std::filesystem::path& folder, const OlatOptions& options);

// Throws InputError if `output` is a folder in which the next run would take results for images:
// that of the images, of the chrome ball, or the folder that was given.
void CheckOutputFolder(const OlatCapture& capture, const std::filesystem::path& output);

// The directions of the lights from the highlights on the chrome ball of the capture.
// Throws InputError naming the file.
std::vector<DirectionalLight> LightsFromChrome(const OlatCapture& capture, InputEncoding encoding);

}  // namespace nerf
