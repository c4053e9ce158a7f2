#pragma once

#include <filesystem>

#include "nerf/scene/posed_images.h"

namespace nerf::sfm {

// Reads a transforms.json in the flavours of instant-ngp, nerfstudio and Blender (NeRF-synthetic):
// world_from_camera matrices with OpenGL camera axes, lenses for the whole file or frame by frame
// (keys: transforms_json_camera.h), file_path relative to the JSON, with or without an ending.
//   - transforms_train.json brings transforms_test.json and transforms_val.json beside it along,
//     each image marked with its split. nerfstudio's train_filenames, val_filenames and
//     test_filenames mark splits too. Whatever is trained on is never test or validation.
//   - Images without a readable file go to `missing`; the others come sorted by name.
//   - mask_path names a frame's mask, black where pixels are masked out (nerfstudio).
//   - Pixels are taken as stored, as COLMAP and others see them, unless the size fits only after
//     turning by EXIF, or our own key upright_by_exif says so.
//   - Where the image is a larger or smaller copy of what w and h say, the lens is scaled to it.
// Poses are in the world and units of the file. Sources: instant-ngp docs/nerf_dataset_tips.md;
// nerfstudio docs "Data conventions"; Mildenhall et al. 2020 (Blender).
// Throws InputError with file, frame and key when something is missing, of the wrong type, not
// finite, not rigid, or named twice, and when no image is there.
//   absent  what becomes of images without a readable file. Kept ones, of a file that says their
//           size, have poses and lenses to render from; they are in `missing` too.
enum class AbsentImages { kLeaveOut, kKeep };
PosedImages ReadTransformsJson(const std::filesystem::path& file,
                               AbsentImages absent = AbsentImages::kLeaveOut);

// Writes the same in nerfstudio's flavour, so that ReadTransformsJson gives the images, lenses,
// poses and splits back, names too: file_path relative to the file's folder, per-frame lenses only
// where there is more than one, all digits of a double. Sparse points have no place in it. The file
// appears whole or not at all. Throws InputError when it cannot be written.
void WriteTransformsJson(const PosedImages& posed, const std::filesystem::path& file);

}  // namespace nerf::sfm
