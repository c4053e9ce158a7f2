#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// What happens to images without a readable file.
enum class AbsentImages {
  kLeaveOut,
  kKeep,  // their poses and lenses are kept, to render from; needs w and h
};

// Reads a transforms.json of instant-ngp, nerfstudio or Blender (NeRF-synthetic): world_from_camera
// matrices with OpenGL camera axes, lenses for the whole file or per frame (keys:
// transforms_json_camera.h), file_path relative to the JSON file, with or without an extension, in
// upper or lower case (FindImageFile).
//   - With transforms_train.json, transforms_test.json and transforms_val.json beside it are read,
//     and each image is marked with its split. nerfstudio's train_filenames, val_filenames and
//     test_filenames mark splits too. A training image is never test or validation.
//   - mask_path is a frame's mask (nerfstudio); those that do not exist are in `warnings`.
//   - A scale that the axes of a pose have in common is taken out, and is in `warnings`.
//   - Pixels are taken as stored, as COLMAP takes them, unless their size fits w and h only after
//     rotation by EXIF, or our own key upright_by_exif is set.
//   - A frame may name its light: "light" is that of all photographs under the same light;
//     "light_direction" points to a single distant light in a dark room, and "light_irradiance" is
//     its irradiance on a surface that faces it, by default pi (white then has the value 1).
//   - Where the image is a scaled copy of w x h, the lens is scaled to it.
// Sources: instant-ngp docs/nerf_dataset_tips.md; nerfstudio docs "Data conventions"; Mildenhall et
// al. 2020 (Blender).
//   returns  images sorted by name, in the world and units of the file; `missing` lists the images
//            without a readable file
// Throws InputError with file, frame and key when something is missing, of the wrong type, not
// finite, not rigid, or duplicate, and when no image is left.
PosedImages ReadTransformsJson(const std::filesystem::path& file,
                               AbsentImages absent = AbsentImages::kLeaveOut);

// Writes a transforms.json in nerfstudio's conventions, from which ReadTransformsJson restores
// images, names, lenses, poses and splits: file_path relative to the folder of the file, per-frame
// lenses only where there are several, all digits of a double. Sparse points are not written.
// Writes atomically. Throws InputError when the file cannot be written.
void WriteTransformsJson(const PosedImages& posed, const std::filesystem::path& file);

}  // namespace nerf::sfm
