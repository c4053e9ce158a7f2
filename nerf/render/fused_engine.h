#pragma once

#include <vector>

#include "nerf/effects/background_map.h"
#include "nerf/render/engine.h"
#include "nerf/render/fused_forward.h"
#include "nerf/render/pixel_loss.h"

namespace nerf {

struct RayGradient;

// What LibTorchEngine defines, a tile of rays at a time: placing of samples, encoding, networks,
// compositing, loss and the way back run one after the other while the tile's samples are in the
// core's cache, with kernels of our own on LibTorch's parameters, in float.
class FusedEngine : public Engine {
 public:
  explicit FusedEngine(EngineParts parts);
  ~FusedEngine() override;

  RenderOutput Render(const RayBatch& rays) override;
  StepResult AccumulateGradients(const TargetBatch& batch) override;
  void SetProgress(double progress) override;
  void UpdateOccupancy(std::int64_t step, std::uint64_t seed) override;

 private:
  struct Worker;
  void Refresh();
  RenderOutput RenderRays(const RayBatch& rays) const;
  StepResult LearnFrom(const TargetBatch& batch);
  RayGradient GradientOfRays(const RayBatch& rays) const;
  void AddDepthLoss(const TargetBatch& batch, std::int64_t first, Worker& worker) const;
  void Backward(const TargetBatch& batch, std::int64_t first, Worker& worker,
                std::span<float> ray_error) const;

  EngineParts parts_;
  FusedForward forward_;
  BackgroundMap background_;  // where it is learned
  PixelModel pixel_model_;
  std::vector<Worker> workers_;  // one a thread
};

}  // namespace nerf
