#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/image/image.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

struct Model;

// A fixed sample of the pixels of validation photographs.
class Validation {
 public:
  //   views  may be empty: then there is no validation
  Validation(const std::vector<View>& views, std::uint64_t seed);

  bool Empty() const { return batch_.rays.Size() == 0; }

  // PSNR, dB, the mean over the photographs as that of `nerf eval`, with the model's refined focal
  // lengths, and its refined poses for photographs of which a part is trained on. With
  // fit_exposure, each photograph is rendered at its own exposure, fitted to it: for models that
  // simulate exposures, and for those compared with them.
  double Psnr(const Model& model, bool fit_exposure) const;
  // The same of colours and opacities that something else has rendered at these pixels.
  double Psnr(RenderOutput rendered, bool fit_exposure, ColorEncoding encoding) const;

  // The pixels, their colours, and their backgrounds.
  const TargetBatch& Targets() const { return batch_; }

 private:
  RayBatch Rays(const Model& model) const;

  TargetBatch batch_;
  std::vector<std::string> names_;  // of the views
  std::vector<float> axis_;         // [R,3] optical axis of each ray's camera
  std::vector<std::int64_t> lens_;  // [R]
};

}  // namespace nerf
