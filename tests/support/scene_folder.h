#pragma once

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <vector>

#include "tests/support/colmap_database_file.h"
#include "tests/support/feature_scene.h"
#include "tests/support/photo_files.h"

namespace nerf::test {

// Writes a plain photograph for each image of a scene, and sets its path.
//   returns  what COLMAP would find in them, under the names that FindSparsePoints gives it
inline std::vector<DatabaseImage> WritePhotographsOf(FeatureScene& scene,
                                                     const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<DatabaseImage> found;
  for (std::size_t i = 0; i < scene.posed.images.size(); ++i) {
    PosedImage& image = scene.posed.images[i];
    image.path = folder / image.name;
    WritePhoto(image.path, 640, 480);
    found.push_back({fmt::format("{:06}.png", i), scene.features[i]});
  }
  return found;
}

}  // namespace nerf::test
