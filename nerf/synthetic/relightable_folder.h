#pragma once

#include <filesystem>
#include <functional>

namespace nerf::synthetic {

// How the relightable scene is photographed.
struct RelightableOptions {
  int views = 40;                 // to train on, 2 to 1000
  int test_views = 8;             // held out
  int width = 160, height = 160;  // pixels, up to 8192
  int paths = 64;                 // light paths a pixel, 4 to 1,000,000
  int lights = 1;                 // under which the photographs are taken in turn, 1 to 3
  int bounces = 2;

  // Throws InputError, naming the flag, if a value is out of range.
  void Check() const;
};

// Writes a capture of known materials into a folder, which is created if it does not exist:
//   transforms_train.json, train/view_000.png     photographs, sRGB, with alpha; their lights
//   transforms_test.json, test/view_000.png       held-out views under the first light, and
//   test/view_000_LIGHT.png                       under all others
//   gt/view_000_albedo.exr, _normal.exr, _material.exr   truth (nerf eval --truth)
//   environments/LIGHT.exr                        the maps
//   relightable.txt                               marks the folder as such a capture
// All of an earlier capture in the folder is replaced.
//   keep_on  called before each picture; false ends the work
//   returns  false if keep_on ended it
// Throws InputError if options are out of range, or the folder contains something else (then
// nothing in it is changed).
bool WriteRelightable(const std::filesystem::path& folder, const RelightableOptions& options,
                      const std::function<bool()>& keep_on);

}  // namespace nerf::synthetic
