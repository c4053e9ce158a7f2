#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "nerf/image/image_size.h"

namespace nerf {

// Whether a file has the extension of an image format that OpenImageIO reads (jpg, png, tif, exr,
// hdr, webp, heic, camera raw, ...), in upper or lower case.
bool HasImageExtension(const std::filesystem::path& file);

// The regular files in a folder (not in subfolders) that have the extension of an image, sorted by
// name. Hidden files are skipped. Empty where the folder does not exist or cannot be listed.
std::vector<std::filesystem::path> ImageFilesIn(const std::filesystem::path& folder);

// The image file that a list of photographs means by `path`: that file; or, where it does not
// exist, the one whose name differs in upper and lower case only, as after a copy from a camera's
// card; or the one that has the extension of an image after this name, which Blender's exporter
// omits. Backslashes between folders, of lists made on Windows, count as slashes where no file has
// them in its name. nullopt if there is none, or several differ in upper and lower case only.
std::optional<std::filesystem::path> FindImageFile(const std::filesystem::path& path);

// Reads only the header. nullopt where OpenImageIO finds no image in the file.
std::optional<ImageSize> ReadImageSize(const std::filesystem::path& file);

}  // namespace nerf
