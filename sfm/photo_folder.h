#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::sfm {

// A photograph that decodes from its first row to its last.
struct Photo {
  std::string name;            // file name in the folder
  std::filesystem::path path;  // absolute
  std::string format;          // as OpenImageIO calls it: "jpeg", "png", "openexr", ...
  int width = 0;               // as stored, before turning by EXIF
  int height = 0;
  int orientation = 1;    // EXIF, 1 (upright) to 8
  bool eight_bit = true;  // false: more bits an integer, or float

  int UprightWidth() const { return orientation >= 5 ? height : width; }
  int UprightHeight() const { return orientation >= 5 ? width : height; }
};

// A file that has the name of a photograph and is none.
struct SkippedPhoto {
  std::string name;
  std::string reason;
};

struct PhotoFolder {
  std::vector<Photo> photos;          // in the order of their names
  std::vector<SkippedPhoto> skipped;  // likewise
};

// The files of a folder whose ending is that of an image (HasImageEnding), absolute, sorted by name
// as strings; hidden files and subfolders are left out. Reads no file.
// Throws InputError when the folder is missing or no folder, or holds fewer than two such files.
std::vector<std::filesystem::path> ListPhotos(const std::filesystem::path& folder);

// Decodes every file once, on `threads` threads (0: all cores), holding a few rows at a time, and
// sorts out those that cannot be read: cut short, empty, of another kind. A JPEG that ends early is
// found too, though the JPEG library fills in grey and only warns.
// Throws InputError when fewer than two are left.
PhotoFolder CheckPhotos(const std::vector<std::filesystem::path>& files, int threads = 0);

}  // namespace nerf::sfm
