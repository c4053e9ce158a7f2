#pragma once

#include <string>

namespace sfm {

struct ColmapOptions {
  // Which photographs are compared: "exhaustive", every pair; "sequential", neighbours by name
  // (the 20 next, and at distances of powers of two); "auto", sequential for more than 100
  // photographs of one size that are numbered without large gaps, else exhaustive.
  std::string matcher = "auto";
  std::string camera_model = "OPENCV";  // any of CameraModelName
  int max_image_size = 1600;  // pixels, longer side; features are found in photos reduced to this
  // Features a photograph, those of the largest scale. The time to match two photographs grows
  // with its square.
  int max_num_features = 4096;
  int threads = 0;  // 0: all cores

  // Throws InputError that names the option and what it may be.
  void Check() const;
};

}  // namespace sfm
