#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "nerf/config/train_options.h"
#include "nerf/effects/depth.h"
#include "nerf/effects/footprint.h"
#include "nerf/effects/robust.h"
#include "nerf/kernels/mlp.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/render/stage_seconds.h"
#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

class Background;
class Exposure;
class OccupancyGrid;
class Poses;
class ProposalField;
class RadianceField;

struct StepResult {
  double loss = 0;           // mean over rays and channels
  double squared_error = 0;  // mean over rays and channels, for PSNR
  std::int64_t marched = 0;  // samples in occupied cells
  std::int64_t shaded = 0;   // samples of them that light reaches, on which gradients were taken
  // [R] squared error of each ray, mean over channels; of a robust loss, the part of it that pulls:
  // rays are not to be drawn where somebody passes by.
  std::vector<float> ray_error;
  StageSeconds seconds;
};

// What an engine works on. Where there is a proposal it places the samples, else the grid does.
struct EngineParts {
  std::shared_ptr<RadianceField> field;
  std::shared_ptr<OccupancyGrid> grid;
  std::shared_ptr<ProposalField> proposal;  // may be null
  MarchOptions march;
  ProposalOptions proposal_options;
  LossOptions loss;
  GradientScalingOptions gradient_scaling;
  // Of the networks' products in FusedEngine; LibTorchEngine is exact to float.
  kernels::Precision precision = kernels::Precision::kFloat;
  // Effects; empty where they are not simulated.
  std::shared_ptr<Poses> poses;
  std::optional<FootprintOptions> footprint;
  std::shared_ptr<Background> background;
  std::shared_ptr<Exposure> exposure;
  std::optional<RobustOptions> robust;
  std::optional<DepthOptions> depth;
};

// Evaluates rays, with gradients or without. Two engines, one meaning: LibTorchEngine composes
// autograd operations and is the definition; a fused engine may take its place behind this door.
// The trainer, the optimiser and the commands never know which one runs.
class Engine : public RayRenderer {
 public:
  // Renders the rays, compares them with the targets, and leaves dL/dparameter in the gradients of
  // the field's parameters (which must be undefined or zero before).
  // Throws NonFiniteError when the loss is not finite.
  virtual StepResult AccumulateGradients(const TargetBatch& batch) = 0;

  // How much of the training is over, in [0, 1], for what changes on the way; 1 before it is told.
  virtual void SetProgress(double progress) = 0;

  // Draws fresh densities into the occupancy grid; nothing where a proposal takes its place.
  virtual void UpdateOccupancy(std::int64_t step, std::uint64_t seed) = 0;
};

}  // namespace nerf
