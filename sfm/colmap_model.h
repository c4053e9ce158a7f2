#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Whether a folder contains cameras and images as .bin or .txt.
bool IsColmapModel(const std::filesystem::path& folder);

// Reads a COLMAP model: cameras and images, and points3D where the folder has it, binary
// (preferred) or text, with all eleven camera models of COLMAP 3.8.
//   returns  images sorted by name, in the world and units of the model. Those without a readable
//            file in image_folder are in `missing`, and their observations are dropped.
//            upright_by_exif is set only where the size of the camera fits no other way, since
//            COLMAP ignores EXIF.
// Throws InputError naming the file when one is missing, truncated or inconsistent, naming the
// image when its pose is not finite or its size differs from its camera's, and when no image is
// left.
PosedImages ReadColmapModel(const std::filesystem::path& model_folder,
                            const std::filesystem::path& image_folder);

// The names of the images that a model has registered, in the file's order.
std::vector<std::string> ColmapImageNames(const std::filesystem::path& model_folder);

// The number of images that a model has registered, without reading them.
int CountRegistered(const std::filesystem::path& model_folder);

// The folders 0, 1, ... that contain a model, sorted by number: COLMAP writes one for each part of
// the scene that it could not connect to another.
std::vector<std::filesystem::path> SubModels(const std::filesystem::path& sparse_folder);

// Records which of the models of a project is the one to use, where it is not the largest: in
// chosen.txt, a path relative to the folder of the models.
void ChooseModel(const std::filesystem::path& sparse_folder, const std::filesystem::path& model);
// The recorded one; nothing if there is none, or it is not there any more.
std::optional<std::filesystem::path> ChosenModel(const std::filesystem::path& sparse_folder);

// The sub-model with most registered images, and among equals the lowest number. Throws InputError
// when there is none.
std::filesystem::path LargestModel(const std::filesystem::path& sparse_folder);

}  // namespace nerf::sfm
