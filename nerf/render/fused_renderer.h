#pragma once

#include "nerf/effects/background_map.h"
#include "nerf/render/fused_forward.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// FusedEngine's forward pass alone.
class FusedRenderer : public RayRenderer {
 public:
  // `parts` must outlive it and must not change.
  explicit FusedRenderer(const ModelParts& parts);

  RenderOutput Render(const RayBatch& rays) const override;

 private:
  RenderOutput RenderRays(const RayBatch& rays) const;

  const ModelParts& parts_;
  FusedForward forward_;
  BackgroundMap background_;  // if learned
};

}  // namespace nerf
