#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "nerf/effects/background.h"
#include "nerf/effects/background_map.h"
#include "nerf/field/libtorch.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

// Surroundings at infinity, such as a sky: a learned colour per direction, composited behind the
// field. Without it the field has to represent them by distant opaque density. The colours are an
// equirectangular map, see BackgroundMap.
class Background : public torch::nn::Module {
 public:
  // Grey before Initialize: sRGB-encoded 0.5, linear 1.
  Background(const BackgroundOptions& options, ColorEncoding encoding);

  // directions [R,3] unit vectors -> [R,3]. Differentiable in the map, not in the directions.
  // Throws c10::Error on a shape mismatch.
  torch::Tensor forward(const torch::Tensor& directions);

  // A copy of the current map.
  BackgroundMap Map() const;

  // Initializes the map from training rays (InitializeBackground), so that training does not first
  // explain the background by floaters.
  void Initialize(const TargetBatch& batch);

  // Adds to the gradient of the map.
  //   dL_draw  [rows, 2 * rows, 3]
  void AddGradient(std::span<const float> dL_draw);

 private:
  torch::Tensor Raw() const;  // [rows * 2 * rows, 3], a view of table_

  int rows_;
  ColorEncoding encoding_;
  torch::Tensor table_;  // [rows * 2 * rows, 4]; the last column is padding
};

}  // namespace nerf
