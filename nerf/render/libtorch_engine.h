#pragma once

#include <memory>
#include <span>
#include <vector>

#include "nerf/field/pose_refinement.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/engine.h"
#include "nerf/render/proposal_sampling.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {

// The definition of rendering and training: each stage is an autograd operation on whole batches,
// in float or, after field->to(torch::kDouble), in double.
class LibTorchEngine : public Engine {
 public:
  // `parts` must outlive it.
  explicit LibTorchEngine(const ModelParts& parts) : parts_(parts) {}

  using Engine::AccumulateGradients;
  RenderOutput Render(const RayBatch& rays) const override;
  StepResult AccumulateGradients(const TargetBatch& batch, const StepContext& context) override;
  void UpdateOccupancy(const StepContext& context) override;

 private:
  struct Evaluated;
  const EffectsOptions& Effects() const { return parts_.config.effects; }
  torch::Tensor DepthLoss(const TargetBatch& batch, const Evaluated& out) const;
  torch::Tensor BackgroundOf(const RayBatch& rays) const;
  torch::Tensor TrainingBackground(const RayBatch& rays,
                                   const std::vector<std::int64_t>& photograph) const;
  Evaluated Evaluate(const RayBatch& rays, const torch::Tensor& background,
                     const RefinedRays* refined, const Annealing& annealing) const;
  PackedSamples VisibleSamples(const RayBatch& rays, const PackedSamples& samples,
                               double detail) const;
  std::vector<float> FootprintsOf(const RayBatch& rays, const PackedSamples& samples) const;
  torch::Tensor AntiAliasingWeightsOf(std::span<const float> footprint) const;
  using DensityFunction = torch::Tensor (RadianceField::*)(const torch::Tensor&,
                                                           const torch::Tensor&, double);
  std::vector<float> Densities(std::span<const float> positions, std::span<const float> footprint,
                               double detail, DensityFunction density) const;

  const ModelParts& parts_;
};

}  // namespace nerf
