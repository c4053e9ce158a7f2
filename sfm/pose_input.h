#pragma once

#include <filesystem>
#include <optional>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

enum class InputKind { kTransforms, kColmap, kLlff, kPhotos, kFilm };

// The kind of an input and its files.
struct InputLocation {
  InputKind kind = InputKind::kPhotos;
  // JSON file, COLMAP model folder, or poses_bounds.npy; empty without poses.
  std::filesystem::path model;
  std::filesystem::path images;  // folder of the photographs; for kFilm, the film
};

// Finds the poses and photographs of an input path. Tries in this order:
//   a .json file                           transforms.json of any flavour
//   transforms.json, transforms_train.json the same, in the folder
//   poses_bounds.npy                       LLFF
//   a COLMAP model in the folder itself, sparse/, sparse/N, colmap/sparse/, colmap/sparse/N or N
//                                          of the N the one with most registered images;
//                                          photographs in images/ beside or above it, in the folder
//                                          itself, or in images_2, images_4 or images_8, whichever
//                                          contains most of the model's images
//   image files in the folder or below it  photographs without poses
//   a film, or a folder with one           a film
// Throws InputError when the input is missing or none of these, with the list of what was tried.
InputLocation FindInput(const std::filesystem::path& input);

// The film that an input is, or that is all there is in its folder; nullopt for other inputs, valid
// or not.
std::optional<std::filesystem::path> FindFilm(const std::filesystem::path& input);

// Reads an input with poses. Throws InputError for kPhotos and kFilm, and as ReadTransformsJson,
// ReadColmapModel and ReadLlff do.
PosedImages ReadPosedInput(const InputLocation& location);

}  // namespace nerf::sfm
