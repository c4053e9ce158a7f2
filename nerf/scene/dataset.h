#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/options.h"
#include "nerf/image/image.h"
#include "nerf/image/mask.h"
#include "nerf/scene/data_options.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/scene/view.h"

namespace nerf {

struct Dataset {
  std::vector<View> train;
  std::vector<View> validation;
  ColorEncoding encoding = ColorEncoding::kSrgb;
  bool has_alpha = false;            // some pixel is not opaque
  int linearized_photographs = 0;    // display-referred ones in a capture that also has linear ones
  std::vector<std::string> skipped;  // why photographs were skipped, one message each
};

// Reads the training and validation photographs; needs their splits (AssignSplits). Uses all
// threads, or as many (at least one) as can decode at once within another DataOptions::memory_mb.
// A photograph that cannot be read is skipped with a message in `skipped`. Where some photographs
// are linear (EXR, HDR), the others are converted to linear. Pixels that a mask excludes and
// clipped pixels of converted photographs are not stored, so never drawn.
//   masks  nullopt: masks are ignored
// Throws InputError where a mask does not fit, where no training image is left, or where every
// photograph is fully transparent.
Dataset LoadDataset(const PosedImages& posed, const DataOptions& options,
                    std::optional<MaskMeaning> masks,
                    const SceneNormalization& normalized_from_world);

// The background behind transparent pixels of rendered images: white where photographs have alpha
// (the NeRF-synthetic protocol), black elsewhere.
Eigen::Vector3f DisplayBackground(bool has_alpha);

}  // namespace nerf
