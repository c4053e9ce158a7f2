#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "nerf/relight/surface_shading.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// A change of the material of a surface, everywhere or inside a box.
struct MaterialEdit {
  struct Box {
    Eigen::AlignedBox3d in_world;  // units and axes of the input
    SceneNormalization frame;      // of the surface
  };
  std::optional<Box> box;
  std::optional<std::array<double, 3>> set_color, scale_color;
  std::optional<double> set_roughness, scale_roughness;
  std::optional<double> set_metallic;
};

// [P] bool, which points [P,3] of the normalized frame are inside its box.
torch::Tensor IsInside(const MaterialEdit& edit, const torch::Tensor& positions);

// Changes the materials of points; results stay in their ranges. A roughness or metallic gives a
// matt surface a coat.
void Apply(const MaterialEdit& edit, const torch::Tensor& positions, MaterialBatch& material);

// Reads
//   [{"box": {"min": [-1, -1, 0], "max": [0, 1, 1]},
//     "albedo": {"scale": [0.2, 0.4, 2]}, "roughness": {"set": 0.1}, "metallic": {"set": 1}}]
// A box is in the units and axes of the input, and may be absent: everywhere. Albedo is linear; a
// value for all channels may be a number.
//   vertices  of the surface, normalized frame
// Throws InputError naming the file and the key, and a box that holds none of the vertices.
std::vector<MaterialEdit> ReadMaterialEdits(const std::filesystem::path& file,
                                            const SceneNormalization& frame,
                                            const std::vector<Eigen::Vector3f>& vertices);

}  // namespace nerf
