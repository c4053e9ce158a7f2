#pragma once

#include <memory>

#include "nerf/render/model_parts.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// What renders the views of a model as it is now: exact at quality 1, by the engine that it was
// trained with, else a PacketRenderer with RenderQuality::Of(quality). `parts` must outlive it, and
// not change. Throws InputError where quality is not in [0, 1].
std::shared_ptr<const RayRenderer> MakeRenderer(const ModelParts& parts, double quality = 1);

}  // namespace nerf
