#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "nerf/config/material_options.h"
#include "nerf/relight/light_transport.h"
#include "nerf/relight/material_field.h"
#include "nerf/relight/relightable_surface.h"
#include "nerf/relight/surface_observations.h"
#include "nerf/train/optimizer.h"

namespace nerf {

// Finds the material of a surface, and the light that shines on it, from photographs: Adam on the
// difference between what the surface reflects (Shade) and what is observed, in sRGB. Light that
// other parts of the surface reflect is that which photographs show there.
//
// The product of albedo and light is all that photographs tell. Where the light is not given, its
// scale is pinned by a prior: the mean radiance over all directions is white and near
// kMeanRadiance, so that a matt surface of albedo 0.8 in full light is just not clipped.
class MaterialFit {
 public:
  static constexpr double kMeanRadiance = 0.6;

  //   known_light  [D,3] radiance from the directions of `transport`, in units of the photographs;
  //                undefined: it is found
  // All inputs are kept. Throws c10::Error where nothing is observed.
  MaterialFit(SurfaceObservations observations, LightTransport transport,
              std::shared_ptr<MaterialField> field, const MaterialOptions& options,
              std::uint64_t seed, const torch::Tensor& known_light = {});

  // One step at a position of the fit, 0 to 1. Returns the mean squared error, of sRGB values. The
  // same seed gives the same bits.
  // Throws NonFiniteError naming the step.
  double Step(double progress);

  std::int64_t Steps() const { return step_; }
  // [D,3]
  torch::Tensor Light() const;
  // [V,3] what is observed at the vertices: of the indirect light.
  const torch::Tensor& Observed() const { return observed_; }

 private:
  struct Batch;
  Batch DrawBatch() const;
  torch::Tensor Priors(const Batch& batch, const SurfaceProperties& found,
                       const torch::Tensor& light) const;

  SurfaceObservations observations_;
  LightTransport transport_;
  std::shared_ptr<MaterialField> field_;
  MaterialOptions options_;
  std::uint64_t seed_;
  torch::Tensor observed_;
  bool is_light_known_;
  torch::Tensor log_light_;  // [D,3]
  Adam material_optimizer_;
  std::optional<Adam> light_optimizer_;
  std::int64_t step_ = 0;
};

}  // namespace nerf
