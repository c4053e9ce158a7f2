#pragma once

#include <memory>
#include <utility>

#include "nerf/effects/background_map.h"
#include "nerf/field/background.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// The rays with what the map shows in their directions as their background.
RayBatch WithBackground(const RayBatch& rays, const BackgroundMap& map);

// What another renderer shows, before that background.
class BackgroundRenderer : public RayRenderer {
 public:
  BackgroundRenderer(std::shared_ptr<RayRenderer> inner, std::shared_ptr<Background> background)
      : inner_(std::move(inner)), background_(std::move(background)) {}
  RenderOutput Render(const RayBatch& rays) override;

 private:
  std::shared_ptr<RayRenderer> inner_;
  std::shared_ptr<Background> background_;
};

}  // namespace nerf
