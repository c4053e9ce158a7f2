#pragma once

#include <memory>

#include "nerf/render/model_parts.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// The renderer of a quality: the exact one of the configured engine at quality 1, else a
// PacketRenderer with RenderQuality::Of(quality). `parts` must outlive it and must not change.
// Throws InputError if quality is not in [0, 1].
std::shared_ptr<const RayRenderer> MakeRenderer(const ModelParts& parts, double quality = 1);

}  // namespace nerf
