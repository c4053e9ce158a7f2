#pragma once

#include <span>
#include <vector>

#include "nerf/effects/background_map.h"
#include "nerf/render/engine.h"
#include "nerf/render/fused_forward.h"
#include "nerf/render/pixel_loss.h"

namespace nerf {

struct RayGradient;

// Computes what LibTorchEngine defines, one tile of rays at a time: sample placement, encoding,
// networks, compositing, loss and backward pass run in sequence while the tile's samples are in the
// core's cache, with hand-written kernels on LibTorch's parameters, in float.
class FusedEngine : public Engine {
 public:
  // `parts` must outlive it.
  explicit FusedEngine(const ModelParts& parts);
  ~FusedEngine() override;

  using Engine::AccumulateGradients;
  RenderOutput Render(const RayBatch& rays) const override;
  StepResult AccumulateGradients(const TargetBatch& batch, const StepContext& context) override;
  void UpdateOccupancy(const StepContext& context) override;

 private:
  struct Worker;
  void Refresh(const StepContext& context);
  StepResult RunBatch(const TargetBatch& batch);
  void RunShare(const TargetBatch& batch, std::int64_t first, std::int64_t last, Worker& worker,
                std::span<float> ray_error);
  StepResult ReduceWorkers(std::int64_t rays);
  RayGradient GradientOfRays(const RayBatch& rays) const;
  void AddDepthLoss(const TargetBatch& batch, std::int64_t first, Worker& worker) const;
  void Backward(const TargetBatch& batch, std::int64_t first, Worker& worker,
                std::span<float> ray_error) const;

  const ModelParts& parts_;
  FusedForward forward_;
  BackgroundMap background_;  // if learned
  PixelModel pixel_model_;
  std::vector<Worker> workers_;  // one per thread
};

}  // namespace nerf
