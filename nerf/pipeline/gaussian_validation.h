#pragma once

#include "nerf/model/gaussian_model.h"
#include "nerf/pipeline/gaussian_scene.h"
#include "nerf/train/validation.h"

namespace nerf {

// Measures Gaussians at the same pixels of validation photographs as a field in training, so that
// the two can be compared.
class GaussianValidation {
 public:
  //   scene, data  must outlive this
  GaussianValidation(const GaussianScene& scene, const Dataset& data);

  bool Empty() const { return validation_.Empty(); }
  // PSNR, dB (Validation::Psnr).
  double Psnr(const GaussianCloud& cloud, double near) const;
  // That of a field.
  double Psnr(const Model& field) const;

 private:
  const GaussianScene& scene_;
  Validation validation_;
};

}  // namespace nerf
