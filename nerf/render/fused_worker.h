#pragma once

#include <cstdint>
#include <vector>

#include "nerf/render/fused_engine.h"

namespace nerf {

// The state of one thread, which processes its share of a batch.
struct FusedEngine::Worker {
  FusedTile tile;
  FieldGradients field;
  DensityGradients proposal;
  PixelLoss pixels;
  StageSeconds seconds;  // of the thread
  std::vector<float> dL_dsigma, dL_dradiance, dL_dbackground;
  std::vector<float> background;      // gradients, in the layout of BackgroundMap::raw
  std::vector<float> costs, weights;  // [S] for depth supervision
  // [S] of all samples of the share, for pose refinement.
  std::vector<std::int64_t> ray;
  std::vector<float> t, dL_dlog_sigma;
};

}  // namespace nerf
