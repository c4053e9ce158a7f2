#pragma once

#include <string>

namespace nerf::sfm {

struct ColmapOptions {
  // Which photographs are compared: "exhaustive", every pair; "sequential", neighbours by name
  // (the 20 next, and at distances of powers of two); "guided", every pair by its largest features
  // first, and in full those pairs that look most alike; "auto", sequential for more than 100
  // photographs of one size that are numbered without large gaps, exhaustive for up to 20, else
  // guided. Where a name has a space in it, guided is exhaustive.
  std::string matcher = "auto";
  std::string camera_model = "OPENCV";  // any of CameraModelName
  int max_image_size = 1600;  // pixels, longer side; features are found in photos reduced to this
  // (and in photos enlarged by two where it comes to less than 1200)
  // Features a photograph, those of the largest scale. The time to match two photographs grows
  // with its square.
  int max_num_features = 2048;
  int threads = 0;  // 0: all cores

  // Throws InputError that names the option and what it may be.
  void Check() const;
};

}  // namespace nerf::sfm
