#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sfm/photo_folder.h"

namespace nerf::sfm {

// The image that COLMAP reads for one photograph.
struct ColmapImage {
  int photo = 0;           // index into the photographs
  std::string name;        // relative to the image folder; '/' between folders
  bool converted = false;  // a converted copy, since COLMAP cannot use the original
};

// Plans COLMAP's image folder, one image per photograph.
//   - COLMAP ignores the EXIF orientation: rotated photographs get an upright copy.
//   - COLMAP works with 8 bits: float, 16-bit and rarer formats get an 8-bit copy.
//   - All others are linked, so that COLMAP reads their EXIF data.
//   - Photographs of one size and one sub-folder share a camera. Several sizes get a folder each
//     ("1080x1920/0001.jpg"), for COLMAP's single_camera_per_folder.
//   - Cropped photographs get a copy without EXIF, whose focal length is that of the whole picture.
std::vector<ColmapImage> PlanColmapImages(const std::vector<Photo>& photos);

enum class PhotoLinks {
  kSymbolic,
  kHard,  // for versions of COLMAP that name photographs by what symbolic links point to
};

// Creates that folder, which must be empty or missing: links (or copies, where the file system does
// not support links) and converted copies. Linear pixels are scaled so that the brightest percent
// is white, then converted to sRGB.
//   threads  0: all cores
// Throws InputError when it cannot be written.
void WriteColmapImages(const std::vector<Photo>& photos, const std::vector<ColmapImage>& plan,
                       const std::filesystem::path& image_folder, int threads = 0,
                       PhotoLinks links = PhotoLinks::kSymbolic);

}  // namespace nerf::sfm
