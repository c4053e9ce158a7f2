#pragma once

#include <memory>

#include "nerf/model/model.h"
#include "nerf/render/ray_renderer.h"

namespace nerf {

// What renders a model's views: its engine where the dial is at 1, exact, else a PacketRenderer
// with RenderQuality::Of the dial. Throws InputError where the dial is not in [0, 1].
std::shared_ptr<RayRenderer> ViewRenderer(const Model& model, double quality);

}  // namespace nerf
