#pragma once

#include <string>

namespace nerf::sfm {

struct ColmapOptions {
  // Which pairs of photographs are matched:
  //   "exhaustive"  all
  //   "sequential"  neighbours by name: the next 20, and those at distances of powers of two
  //   "guided"      all by their largest features, then the most similar pairs by all features
  //   "auto"        sequential for more than 100 photographs of one size that are numbered without
  //                 large gaps, exhaustive for up to 20, else guided
  std::string matcher = "auto";
  std::string camera_model = "OPENCV";  // any of CameraModelName
  // Longer side, in pixels, to which photographs are reduced for feature extraction. Where it is
  // less than 1200, features are also extracted from the photographs enlarged by two.
  int max_image_size = 1600;
  // Extract features also from the photographs enlarged by two, whatever their size: finer ones, in
  // four times the time.
  bool enlarge = false;
  // Features per photograph, those of largest scale. The time to match a pair grows with the
  // square.
  int max_num_features = 2048;
  int threads = 0;  // 0: all cores

  // Throws InputError that names the option and its valid values.
  void Check() const;
};

}  // namespace nerf::sfm
