#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nerf::sfm {

// A photograph that decodes from its first row to its last.
struct Photo {
  std::string name;            // path in the folder, with '/' between sub-folders
  std::filesystem::path path;  // absolute
  std::string format;          // OpenImageIO's name: "jpeg", "png", "openexr", ...
  int width = 0;               // as stored, before rotation by EXIF
  int height = 0;
  int orientation = 1;    // EXIF, 1 (upright) to 8
  bool eight_bit = true;  // false: integers of more bits, or float
  // EXIF describes another picture, of which this one is no scaled copy: it was cropped, and the
  // focal length in EXIF is not that of its width.
  bool cropped_after_exif = false;

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

// A file with the extension of an image.
struct PhotoFile {
  std::string name;            // path in the folder, with '/' between sub-folders
  std::filesystem::path path;  // absolute
};

// The files of a folder and its sub-folders that have the extension of an image
// (HasImageExtension), sorted by name. Left out are hidden files and folders, and folders that hold
// no photographs: masks, depth maps, and the results of nerf. Reads no file. Empty where the folder
// cannot be listed.
std::vector<PhotoFile> PhotosBelow(const std::filesystem::path& folder);

// The same. Throws InputError when the folder is missing or no folder, or has fewer than two such
// files.
std::vector<PhotoFile> ListPhotos(const std::filesystem::path& folder);

// One line on photographs in sub-folders where there are also some in the folder itself, which may
// not be intended; empty otherwise.
std::string DescribeSubFolders(const std::vector<PhotoFile>& files);

// Decodes every file once, a few rows at a time, and skips those that cannot be read: truncated,
// empty, of another format. This includes truncated JPEGs, for which the JPEG library only warns.
//   threads  0: all cores
// Throws InputError when fewer than two files can be read.
PhotoFolder CheckPhotos(const std::vector<PhotoFile>& files, int threads = 0);

// Skips photographs that equal an earlier one byte for byte: their poses would be those of one
// camera twice, and a held-out photograph could be one that is trained on. Throws InputError when
// fewer than two are left.
void SkipDuplicates(PhotoFolder& folder);

}  // namespace nerf::sfm
