#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "nerf/render/model_parts.h"
#include "nerf/render/ray_renderer.h"
#include "nerf/render/stage_seconds.h"
#include "nerf/scene/pixel_sampler.h"

namespace nerf {

// The state of the schedule at a training step, passed to everything that depends on it.
struct StepContext {
  std::int64_t step = 0;
  std::uint64_t seed = 1;           // of the run
  double progress = 1;              // of the training, in [0,1]
  double learning_rate_factor = 1;  // learning rate over the configured one
  Annealing annealing;
};

struct StepResult {
  double loss = 0;           // mean over rays and channels
  double squared_error = 0;  // mean over rays and channels, for PSNR
  std::int64_t marched = 0;  // samples placed
  std::int64_t shaded = 0;   // of these, visible samples, for which gradients were computed
  // [R] squared error of each ray, mean over channels; with a robust loss multiplied by the ray's
  // weight, so that outliers do not attract more rays.
  std::vector<float> ray_error;
  StageSeconds seconds;
};

// Renders rays, and computes gradients of the loss. There are two equivalent engines:
// LibTorchEngine composes autograd operations and is the definition; FusedEngine computes the same
// with hand-written kernels. Callers do not depend on which one is in use.
class Engine : public RayRenderer {
 public:
  // Forward and backward pass of a batch: adds dL/dparameter to the gradients of the model's
  // parameters, which must be undefined or zero before.
  // Throws NonFiniteError if the loss is not finite, std::invalid_argument for invalid rays.
  virtual StepResult AccumulateGradients(const TargetBatch& batch, const StepContext& context) = 0;
  // With the context of a finished training.
  StepResult AccumulateGradients(const TargetBatch& batch) {
    return AccumulateGradients(batch, StepContext());
  }

  // Updates the occupancy grid with current densities. Does nothing where a proposal network places
  // the samples.
  virtual void UpdateOccupancy(const StepContext& context) = 0;
};

// The engine selected by config.train.engine. `parts` must outlive it.
std::unique_ptr<Engine> MakeEngine(const ModelParts& parts);

}  // namespace nerf
