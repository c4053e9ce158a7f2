#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::sfm {

// A photograph that decodes from its first row to its last.
struct Photo {
  std::string name;            // file name in the folder
  std::filesystem::path path;  // absolute
  std::string format;          // OpenImageIO's name: "jpeg", "png", "openexr", ...
  int width = 0;               // as stored, before rotation by EXIF
  int height = 0;
  int orientation = 1;    // EXIF, 1 (upright) to 8
  bool eight_bit = true;  // false: integers of more bits, or float

  int UprightWidth() const { return orientation >= 5 ? height : width; }
  int UprightHeight() const { return orientation >= 5 ? width : height; }
};

// A file with the extension of an image that cannot be read.
struct SkippedPhoto {
  std::string name;
  std::string reason;
};

struct PhotoFolder {
  std::vector<Photo> photos;          // sorted by name
  std::vector<SkippedPhoto> skipped;  // sorted by name
};

// The absolute paths of a folder's files with the extension of an image (HasImageExtension), sorted
// by name. Hidden files and subfolders are skipped. Reads no file. Throws InputError when the
// folder is missing or no folder, or has fewer than two such files.
std::vector<std::filesystem::path> ListPhotos(const std::filesystem::path& folder);

// Decodes every file once, a few rows at a time, and skips those that cannot be read: truncated,
// empty, of another format. This includes truncated JPEGs, for which the JPEG library only warns.
//   threads  0: all cores
// Throws InputError when fewer than two files can be read.
PhotoFolder CheckPhotos(const std::vector<std::filesystem::path>& files, int threads = 0);

}  // namespace nerf::sfm
