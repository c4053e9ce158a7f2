#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/image/linear_image.h"
#include "nerf/light/lights.h"

namespace nerf {

// Photographs of one subject by one camera, each under one light ("one light at a time").
struct OlatCapture {
  std::string name;                           // of the subject
  std::filesystem::path folder;               // in which it was looked for
  std::vector<std::filesystem::path> images;  // all of one size
  std::vector<DirectionalLight> lights;       // of each image
  std::string lights_from;                    // the file or folder that told the directions
  std::optional<std::filesystem::path> mask;
  std::optional<std::filesystem::path> chrome;  // folder of a chrome ball under the same lights
  int width = 0;
  int height = 0;
};

struct OlatOptions {
  // A light file (light_file.h), "chrome", or "auto": lights.txt where there is one, else the ball.
  std::string lights = "auto";
  InputEncoding encoding = InputEncoding::kAuto;
};

// Finds a capture in a folder. The images stand in it, or in its one sub-folder that is no chrome
// ball's and holds no results (normals.exr, relit.exr). `lights.txt`, and the ball's folder
// `chrome` with a mask, are looked for in the images' folder and the one above. An image with
// "mask" in its name is the mask. Images are taken in the order of a list, NAME.txt beside the
// folder NAME, where there is one (a line an image, only the file's name counts; the data sets of
// Washington and Harvard), else by name, numbers by value. Throws InputError: no images, of
// several sizes, several subjects, no lights, or not as many lights as images.
OlatCapture FindOlatCapture(const std::filesystem::path& folder, const OlatOptions& options);

// Throws InputError where results would be written among a capture's images, its chrome
// ball's, or into the folder in which they are looked for, and be taken for more of them the next
// time.
void RefuseAmongImages(const OlatCapture& capture, const std::filesystem::path& output);

// The directions of the lights by the highlights on the capture's chrome ball.
// Throws InputError naming the file.
std::vector<DirectionalLight> LightsFromChrome(const OlatCapture& capture, InputEncoding encoding);

}  // namespace nerf
