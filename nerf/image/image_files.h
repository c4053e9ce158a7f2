#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace nerf {

// Whether a file's name ends as an image's does: jpg jpeg png tif tiff exr hdr webp bmp tga ppm jp2
// dpx, in upper or lower case.
bool HasImageEnding(const std::filesystem::path& file);

// The regular files in a folder (not below it) whose names end as an image's, sorted by name.
// Hidden files are left out. Empty where the folder does not exist or cannot be listed.
std::vector<std::filesystem::path> ImageFilesIn(const std::filesystem::path& folder);

// Size in pixels as stored in the file, and the EXIF orientation (1..8; 5..8 turn by a quarter).
struct ImageSize {
  int width = 0;
  int height = 0;
  int orientation = 1;
};

// Reads the header alone. nullopt where OpenImageIO finds no image in the file.
std::optional<ImageSize> ReadImageSize(const std::filesystem::path& file);

}  // namespace nerf
