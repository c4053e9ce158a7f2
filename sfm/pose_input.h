#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

enum class InputKind { kTransforms, kColmap, kLlff, kPhotos };

// What a person gave us, and where exactly it is.
struct InputLocation {
  InputKind kind = InputKind::kPhotos;
  std::filesystem::path
      model;  // JSON file, COLMAP model folder, poses_bounds.npy; empty for photos
  std::filesystem::path images;  // folder of the photographs
};

// Finds the poses and photographs that an input means, in this order:
//   a .json file                           transforms.json of any flavour
//   transforms.json, transforms_train.json the same, in the folder
//   poses_bounds.npy                       LLFF
//   a COLMAP model in the folder itself, sparse/, sparse/N, colmap/sparse/, colmap/sparse/N or N
//                                          of the N the one with most registered images;
//                                          photographs in images/ beside or above it, or the folder
//                                          itself, whichever holds most of the images it names
//   image files in the folder, or in images/   plain photographs
// Throws InputError when the input is missing, or is none of these, saying what was looked for.
InputLocation FindInput(const std::filesystem::path& input);

// Reads the poses of any kind but kPhotos, whose poses are yet to be found.
// Throws InputError as ReadTransformsJson, ReadColmapModel and ReadLlff do.
PosedImages ReadPosedInput(const InputLocation& location);

}  // namespace nerf::sfm
