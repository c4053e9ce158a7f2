#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "nerf/render/model_parts.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/render/stage_seconds.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

// Where a training stands when it takes a step; handed down to whatever depends on it.
struct StepContext {
  std::int64_t step = 0;
  std::uint64_t seed = 1;           // of the run
  double progress = 1;              // of the training, in [0,1]
  double learning_rate_factor = 1;  // of the configured learning rate
  Annealing annealing;
};

struct StepResult {
  double loss = 0;           // mean over rays and channels
  double squared_error = 0;  // mean over rays and channels, for PSNR
  std::int64_t marched = 0;  // samples placed
  std::int64_t shaded =
      0;  // of them, samples that light reaches: gradients were computed for these
  // [R] squared error of each ray, mean over channels; under a robust loss times the ray's weight,
  // so that rays are not drawn where somebody passes by.
  std::vector<float> ray_error;
  StageSeconds seconds;
};

// Evaluates rays, with gradients or without. Two engines, one meaning: LibTorchEngine composes
// autograd operations and is the definition; FusedEngine computes the same with our own kernels.
// The trainer, the optimiser and the commands never know which one runs.
class Engine : public RayRenderer {
 public:
  // Renders the rays, compares them with the targets, and leaves dL/dparameter in the gradients of
  // the model's parameters (which must be undefined or zero before).
  // Throws NonFiniteError when the loss is not finite.
  virtual StepResult AccumulateGradients(const TargetBatch& batch, const StepContext& context) = 0;
  // As at the end of a training.
  StepResult AccumulateGradients(const TargetBatch& batch) {
    return AccumulateGradients(batch, StepContext());
  }

  // Draws fresh densities into the occupancy grid; nothing where a proposal network takes its
  // place.
  virtual void UpdateOccupancy(const StepContext& context) = 0;
};

// The engine that config.train.engine chooses. `parts` must outlive it.
std::unique_ptr<Engine> MakeEngine(const ModelParts& parts);

}  // namespace nerf
