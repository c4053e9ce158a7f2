#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nerf/light/light_plan.h"
#include "nerf/relight/light_group.h"
#include "nerf/scene/posed_images.h"
#include "nerf/scene/scene_normalization.h"

namespace nerf {

// The lights on the photographs of a capture, and which of them shines on each.
struct PhotographLights {
  std::vector<LightGroup> groups;
  std::map<std::string, std::int64_t> group_of;  // by the name of the photograph
};

// A planned light in the normalized frame, with a radiance from each of the directions of
// LightDirections(directions).
LightGroup LightInFrame(const PlannedLight& light, const SceneNormalization& frame, int directions);

// The light on each photograph of a capture: that of the plan (lights.json), and its single distant
// light, where the capture names one. Without both it is unknown, one for all photographs whose
// light has the same name.
// Throws InputError naming the first photograph of which the light is not clear.
PhotographLights LightsOn(const PosedImages& posed, const std::optional<LightPlan>& plan,
                          const SceneNormalization& frame, int directions);

}  // namespace nerf
