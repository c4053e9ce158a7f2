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

// A batch whose rays have backgrounds that the gains will multiply back to what they are.
//   gain  [photographs,3]
TargetBatch WithUnexposedBackgrounds(TargetBatch batch, std::span<const float> gain);

// How a photograph comes from what the field shows, and what its difference costs.
struct PixelModel {
  LossOptions loss;
  std::optional<RobustOptions> robust;
  std::vector<float> gain;  // [photographs,3] of Exposure; empty where that is not simulated
  bool saturates = false;   // where it is: as Exposure::Saturates
  bool unexposed = false;  // where it is: rays have backgrounds as Exposure::DivideByGains has them
};

// What the pixels of a tile cost, and which way each should change: Exposure, ColorLoss and their
// derivatives in plain loops, for FusedEngine.
struct PixelLoss {
  double loss = 0, squared_error = 0;         // sums over rays and channels, so far
  std::vector<double> dL_dlog_gain;           // as gain, so far
  std::vector<float> dL_drgb;                 // [R,3] of the last tile
  std::vector<float> dL_dopacity, dL_ddepth;  // [R]

  void Clear(const PixelModel& model);

  // Compares the pixels of the rays from `first` on with what the batch says of them. The loss of a
  // batch is the mean over its rays and channels.
  //   rgb        [R,3] of the tile
  //   opacity    [R] of the tile
  //   ray_error  [rays of the batch] as StepResult::ray_error
  // Returns false where the loss of the tile is not finite.
  bool Add(const PixelModel& model, const TargetBatch& batch, std::int64_t first,
           std::span<const float> rgb, std::span<const float> opacity, std::span<float> ray_error);
};

}  // namespace nerf
