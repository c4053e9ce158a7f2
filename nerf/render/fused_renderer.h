#pragma once

#include "nerf/effects/background_map.h"
#include "nerf/render/fused_forward.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// Renders what FusedEngine trains, a tile of rays at a time, without gradients.
class FusedRenderer : public RayRenderer {
 public:
  // The model as it is now: `parts` must outlive it, and not change.
  explicit FusedRenderer(const ModelParts& parts);

  RenderOutput Render(const RayBatch& rays) const override;

 private:
  RenderOutput RenderRays(const RayBatch& rays) const;

  const ModelParts& parts_;
  FusedForward forward_;
  BackgroundMap background_;  // where it is learned
};

}  // namespace nerf
