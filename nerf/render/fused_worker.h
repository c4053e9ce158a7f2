#pragma once

#include <cstdint>
#include <vector>

#include "nerf/render/fused_engine.h"

namespace nerf {

// What one thread keeps of its share of a batch.
struct FusedEngine::Worker {
  FusedTile tile;
  FieldGradients field;
  DensityGradients proposal;
  PixelLoss pixels;
  StageSeconds seconds;  // of the thread
  std::vector<float> dL_dsigma, dL_dradiance, dL_dbackground;
  std::vector<float> background;      // gradients, as BackgroundMap::raw
  std::vector<float> costs, weights;  // [S] of the samples, where distances are learned
  // [S] of all samples so far, where poses are refined.
  std::vector<std::int64_t> ray;
  std::vector<float> t, dL_dlog_sigma;
};

}  // namespace nerf
