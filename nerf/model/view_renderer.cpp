#include "nerf/model/view_renderer.h"

#include "nerf/field/background.h"
#include "nerf/render/background_rays.h"
#include "nerf/render/engine.h"
#include "nerf/render/packet_renderer.h"
#include "nerf/render/render_quality.h"

namespace nerf {

std::shared_ptr<RayRenderer> ViewRenderer(const Model& model, double quality) {
  const Config& config = model.config;
  const RenderQuality of_dial = RenderQuality::Of(quality, config.march, config.proposal);
  if (quality == 1) return model.engine;
  const auto packets = std::make_shared<PacketRenderer>(
      model.field, model.grid, model.proposal, config.march, config.proposal, of_dial,
      PrecisionOf(config), config.effects.footprint);
  if (model.background) return std::make_shared<BackgroundRenderer>(packets, model.background);
  return packets;
}

}  // namespace nerf
