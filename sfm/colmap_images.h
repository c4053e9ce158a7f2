#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sfm/photo_folder.h"

namespace nerf::sfm {

// What COLMAP gets to see of one photograph.
struct ColmapImage {
  int photo = 0;          // index into the photographs
  std::string name;       // below the image folder; '/' between folders
  bool stand_in = false;  // a copy that COLMAP can use, where it could not use the photograph
};

// Lays out COLMAP's image folder, photograph by photograph.
//   - COLMAP ignores EXIF orientation: a photograph that is to be turned gets an upright copy.
//   - COLMAP works with 8 bits: float, 16 bit and rarer formats get an 8-bit copy.
//   - All others are used as they are, through a link, so that COLMAP finds their EXIF data.
//   - Photographs of one size share a camera. With several sizes, each has a folder of its own
//     ("1080x1920/0001.jpg"), to be used with COLMAP's single_camera_per_folder.
std::vector<ColmapImage> PlanColmapImages(const std::vector<Photo>& photos);

// Makes that folder, which must be empty or missing: links (or copies, where the file system knows
// no links) and stand-ins, on `threads` threads (0: all cores). Pixels proportional to radiance are
// scaled so that the brightest percent is white, and pass through the sRGB transfer.
// Throws InputError when it cannot be written.
void WriteColmapImages(const std::vector<Photo>& photos, const std::vector<ColmapImage>& plan,
                       const std::filesystem::path& image_folder, int threads = 0);

}  // namespace nerf::sfm
