#pragma once

#include <cstdint>

#include "nerf/scene/data_options.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// How many images and pixels a training run will load; computed before any photograph is read.
struct DataPlan {
  std::int64_t train = 0, validation = 0, held_out = 0;  // images
  std::int64_t pixels = 0;         // of the training and validation images, downscaled
  std::int64_t stored_pixels = 0;  // of these, as many as fit into DataOptions::memory_mb

  // Memory for the stored pixels.
  std::int64_t Bytes() const;
  // How many of a photograph's pixels are stored, at least one.
  std::int64_t StoredPixelsOf(std::int64_t pixels_of_photograph) const;
};

// Needs the images' splits (AssignSplits).
DataPlan PlanData(const PosedImages& posed, const DataOptions& options);

}  // namespace nerf
