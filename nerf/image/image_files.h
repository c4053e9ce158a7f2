#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace nerf {

// Whether a file has the extension of an image format that OpenImageIO reads (jpg, png, tif, exr,
// hdr, webp, heic, camera raw, ...), in upper or lower case.
bool HasImageExtension(const std::filesystem::path& file);

// The regular files in a folder (not in subfolders) that have the extension of an image, sorted by
// name. Hidden files are skipped. Empty where the folder does not exist or cannot be listed.
std::vector<std::filesystem::path> ImageFilesIn(const std::filesystem::path& folder);

// Size in pixels as stored in the file, and the EXIF orientation (1..8; 5..8 rotate by 90 degrees).
struct ImageSize {
  int width = 0;
  int height = 0;
  int orientation = 1;
};

// Reads only the header. nullopt where OpenImageIO finds no image in the file.
std::optional<ImageSize> ReadImageSize(const std::filesystem::path& file);

}  // namespace nerf
