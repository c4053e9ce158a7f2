#include "nerf/pipeline/photograph_lights.h"

#include <fnmatch.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/relight/environment_light.h"
#include "nerf/relight/light_transport.h"

namespace nerf {
namespace {

// What tells the lights of photographs apart.
struct LightKey {
  std::optional<int> planned;  // index in the plan
  NamedLight named;

  bool operator==(const LightKey&) const = default;
};

// Throws InputError where the plan does not say.
std::optional<int> PlannedFor(const PosedImage& image, const LightPlan& plan) {
  std::optional<int> found;
  for (const auto& [pattern, light] : plan.photographs) {
    if (fnmatch(pattern.c_str(), image.name.c_str(), 0) != 0) continue;
    if (found && *found != light) {
      throw InputError(
          "the photograph {} fits patterns of the lights {} and {}; make the patterns of "
          "photographs narrower",
          image.name, plan.lights[static_cast<std::size_t>(*found)].name,
          plan.lights[static_cast<std::size_t>(light)].name);
    }
    found = light;
  }
  if (!found) found = plan.Find(image.light.name);
  if (!found && plan.lights.size() == 1 && plan.photographs.empty()) found = 0;
  if (!found && !image.light.direction) {
    throw InputError(
        "the photograph {} has none of the lights of the plan; add a pattern that fits it to "
        "photographs",
        image.name);
  }
  return found;
}

// The name of a single light says nothing beyond its direction, and that of the plan is another.
NamedLight WithoutName(NamedLight light) {
  light.name.clear();
  return light;
}

LightKey KeyOf(const PosedImage& image, const std::optional<LightPlan>& plan,
               bool some_have_directions) {
  if (plan) return {PlannedFor(image, *plan), WithoutName(image.light)};
  if (some_have_directions && !image.light.direction) {
    throw InputError(
        "the photograph {} has no light_direction, as others of the capture have; give it, or "
        "describe its light with --lights",
        image.name);
  }
  return {std::nullopt, image.light.direction ? WithoutName(image.light) : image.light};
}

//   planned  those of the plan
LightGroup GroupOf(const LightKey& key, const std::vector<LightGroup>& planned,
                   const SceneNormalization& frame, int directions) {
  LightGroup group;
  if (key.planned) {
    group = planned[static_cast<std::size_t>(*key.planned)];
  } else {
    group.name = key.named.name;
    if (key.named.direction) group.environment = torch::zeros({directions, 3});
  }
  if (key.named.direction) {
    group.lamps.emplace_back(
        DirectionalLight{frame.rotation * *key.named.direction, key.named.irradiance});
  }
  return group;
}

}  // namespace

LightGroup LightInFrame(const PlannedLight& light, const SceneNormalization& frame,
                        int directions) {
  const double gain = std::exp2(light.exposure);
  LightGroup group;
  group.name = light.name;
  if (light.environment) {
    group.environment = gain * RadianceFrom(*light.environment, LightDirections(directions),
                                            TurnedMap(frame.rotation, light.rotate));
  } else if (!light.has_unknown_environment) {
    group.environment = torch::zeros({directions, 3});
  }
  for (const DirectionalLight& sun : light.suns) {
    group.lamps.emplace_back(
        DirectionalLight{frame.rotation * sun.to_light, gain * sun.irradiance});
  }
  for (const PointLight& point : light.points) {
    // Irradiance falls with the square of the distance, in whatever unit that is.
    group.lamps.emplace_back(PointLight{frame.NormalizedFromWorld(point.x_in_world),
                                        gain * frame.scale * frame.scale * point.intensity});
  }
  return group;
}

PhotographLights LightsOn(const PosedImages& posed, const std::optional<LightPlan>& plan,
                          const SceneNormalization& frame, int directions) {
  const bool some_have_directions = std::ranges::any_of(
      posed.images, [](const PosedImage& image) { return image.light.direction.has_value(); });
  std::vector<LightGroup> planned;
  for (std::size_t i = 0; plan && i < plan->lights.size(); ++i) {
    planned.push_back(LightInFrame(plan->lights[i], frame, directions));
  }
  PhotographLights lights;
  std::vector<LightKey> keys;
  for (const PosedImage& image : posed.images) {
    if (image.split == Split::kTest || image.split == Split::kValidation) continue;
    LightKey key = KeyOf(image, plan, some_have_directions);
    const auto known = std::ranges::find(keys, key);
    lights.group_of[image.name] = known - keys.begin();
    if (known != keys.end()) continue;
    lights.groups.push_back(GroupOf(key, planned, frame, directions));
    keys.push_back(std::move(key));
  }
  return lights;
}

}  // namespace nerf
