#include "nerf/render/view_renderer.h"

#include "nerf/render/fused_renderer.h"
#include "nerf/render/libtorch_engine.h"
#include "nerf/render/packet_renderer.h"
#include "nerf/render/render_quality.h"

namespace nerf {

std::shared_ptr<const RayRenderer> MakeRenderer(const ModelParts& parts, double quality) {
  const Config& config = parts.config;
  const RenderQuality options = RenderQuality::Of(quality, config.march, config.proposal);
  if (quality != 1) return std::make_shared<PacketRenderer>(parts, options);
  if (config.train.engine == EngineKind::kLibTorch) return std::make_shared<LibTorchEngine>(parts);
  return std::make_shared<FusedRenderer>(parts);
}

}  // namespace nerf
