#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "nerf/effects/background.h"
#include "nerf/effects/background_map.h"
#include "nerf/field/libtorch.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

// Surroundings without end, such as a sky: a learned colour for each direction, which a ray sees
// where it meets nothing. Without it the field must put an opaque wall somewhere far off for each
// ray. A map of the world by direction; see BackgroundMap for its form.
class Background : public torch::nn::Module {
 public:
  // Grey before Start: sRGB-encoded 0.5, linear 1.
  Background(const BackgroundOptions& options, ColorEncoding encoding);

  // directions [R,3] unit vectors -> [R,3]. Differentiable in the map.
  torch::Tensor forward(const torch::Tensor& directions);

  // As it is now.
  BackgroundMap Map() const;

  // What training starts from: StartFromPhotographs. A map that is right from the start leaves
  // nothing for fog before it to explain.
  void Start(const TargetBatch& batch);

  // Adds to the gradient of the map.
  //   dL_draw  [rows, 2 rows, 3]
  void AddGradient(std::span<const float> dL_draw);

 private:
  torch::Tensor Raw() const;  // [rows * 2 rows, 3], of table_

  int rows_;
  ColorEncoding encoding_;
  torch::Tensor table_;  // [rows * 2 rows, 4], of which three count
};

}  // namespace nerf
