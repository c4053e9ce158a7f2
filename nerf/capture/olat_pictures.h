#pragma once

#include <filesystem>
#include <vector>

namespace nerf {

// The pictures in a folder of photographs under one light at a time.
struct OlatPictures {
  std::vector<std::filesystem::path> images, masks;
};

// The image files in a folder but for ground truth (Normal_gt.*), by name, with numbers compared by
// value.
std::vector<std::filesystem::path> OlatPicturesIn(const std::filesystem::path& folder);

// Tells images and masks apart, and orders the images by the list of the folder, if there is one
// (see FindOlatCapture). Throws InputError if the list names a file that does not exist.
OlatPictures FindOlatPictures(const std::filesystem::path& folder);

}  // namespace nerf
