#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

struct Model;

// A fixed sample of the pixels of photographs that are not trained on, to watch the progress.
class Validation {
 public:
  //   views  may be empty: then there is nothing to measure
  Validation(const std::vector<View>& views, std::uint64_t seed);

  bool Empty() const { return batch_.rays.Size() == 0; }

  // dB, through the lenses as the model has refined them, and at the refined poses of photographs
  // that it was trained on a part of. With fit_exposure each photograph is
  // rendered at its own exposure, which nobody else knows and which is fitted to it: so are models
  // that simulate exposures measured, and those that are to be compared with them.
  double Psnr(const Model& model, bool fit_exposure) const;

 private:
  RayBatch Rays(const Model& model) const;

  TargetBatch batch_;
  std::vector<std::string> names_;  // of the views
  std::vector<float> axis_;         // [R,3] of the rays' cameras
  std::vector<std::int64_t> lens_;  // [R]
};

}  // namespace nerf
