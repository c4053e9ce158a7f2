#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nerf/config/train_options.h"
#include "nerf/effects/robust.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

// Divides the backgrounds of a batch by the gains (Exposure::DivideByGains).
//   gain  [photographs,3]
TargetBatch WithUnexposedBackgrounds(TargetBatch batch, std::span<const float> gain);

// The model of a photograph's pixels, and their loss.
struct PixelModel {
  LossOptions loss;
  std::optional<RobustOptions> robust;
  std::vector<float> gain;  // [photographs,3] Exposure::Gains; empty where the effect is off
  bool saturates = false;   // with gains: Exposure::Saturates
  bool unexposed = false;   // with gains: the rays' backgrounds are divided by them
};

// The loss of the pixels of a tile and its gradients: Exposure, ColorLoss and their derivatives in
// plain loops, for FusedEngine.
struct PixelLoss {
  double loss = 0, squared_error = 0;         // sums over rays and channels, accumulated
  std::vector<double> dL_dlog_gain;           // [photographs,3], accumulated
  std::vector<float> dL_drgb;                 // [R,3] of the last tile
  std::vector<float> dL_dopacity, dL_ddepth;  // [R] of the last tile

  void Clear(const PixelModel& model);

  // Adds the loss of the pixels of a tile, whose first ray is `first` of the batch. The loss of a
  // batch is the mean over its rays and channels.
  //   rgb        [R,3] of the tile
  //   opacity    [R] of the tile
  //   ray_error  [rays of the batch] as StepResult::ray_error
  // Returns false if the loss of the tile is not finite.
  bool Add(const PixelModel& model, const TargetBatch& batch, std::int64_t first,
           std::span<const float> rgb, std::span<const float> opacity, std::span<float> ray_error);
};

}  // namespace nerf
