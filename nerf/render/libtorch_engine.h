#pragma once

#include <memory>
#include <span>
#include <vector>

#include "nerf/field/poses.h"
#include "nerf/field/radiance_field.h"
#include "nerf/render/engine.h"
#include "nerf/render/proposal_sampling.h"
#include "nerf/sampling/occupancy_grid.h"

namespace nerf {

// The definition of what rays see: each stage an autograd operation on whole batches, in float or,
// after field->to(torch::kDouble), in double.
class LibTorchEngine : public Engine {
 public:
  explicit LibTorchEngine(EngineParts parts);

  RenderOutput Render(const RayBatch& rays) override;
  StepResult AccumulateGradients(const TargetBatch& batch) override;
  void SetProgress(double progress) override;
  void UpdateOccupancy(std::int64_t step, std::uint64_t seed) override;

 private:
  struct Evaluated;
  torch::Tensor DepthLoss(const TargetBatch& batch, const Evaluated& out) const;
  torch::Tensor Behind(const RayBatch& rays) const;
  Evaluated Evaluate(const RayBatch& rays, const torch::Tensor& behind, const Poses::Moved* moved);
  PackedSamples VisibleSamples(const RayBatch& rays, const PackedSamples& samples);
  std::vector<float> FootprintsOf(const RayBatch& rays, const PackedSamples& samples) const;
  torch::Tensor SharesOf(std::span<const float> footprint) const;
  using DensityFunction = torch::Tensor (RadianceField::*)(const torch::Tensor&,
                                                           const torch::Tensor&);
  std::vector<float> Densities(std::span<const float> positions, std::span<const float> footprint,
                               DensityFunction density);

  EngineParts parts_;
  std::optional<RobustOptions> robust_;  // as it is now
};

}  // namespace nerf
