#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Whether a folder holds cameras and images as .bin or .txt.
bool IsColmapModel(const std::filesystem::path& folder);

// Reads a COLMAP model: cameras and images, and points3D where the folder has it, binary
// (preferred) or text. All eleven camera models of COLMAP 3.8. Images come sorted by name; those
// without a readable file in image_folder go to `missing`, and their sightings are dropped. COLMAP
// ignores EXIF, so a camera describes the pixels as stored; upright_by_exif is set only where its
// size fits no other way. Poses are world_from_camera in the model's world and units. Throws
// InputError naming the file when one is missing, cut short, or contradicts itself; naming the
// image when a pose is not finite or its size is not the camera's; when no image is there.
PosedImages ReadColmapModel(const std::filesystem::path& model_folder,
                            const std::filesystem::path& image_folder);

// The names of the images that a model has registered, in the file's order.
std::vector<std::string> ColmapImageNames(const std::filesystem::path& model_folder);

// How many images a model has registered, without reading them.
int CountRegistered(const std::filesystem::path& model_folder);

// COLMAP writes a sub-model for each part of the scene that it could not join to another, into the
// folders 0, 1, ...: those of them that hold a model, by number.
std::vector<std::filesystem::path> SubModels(const std::filesystem::path& sparse_folder);

// The sub-model with most registered images, the lowest number among equals. Throws InputError when
// there is none.
std::filesystem::path LargestModel(const std::filesystem::path& sparse_folder);

}  // namespace nerf::sfm
