#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nerf/effects/anti_aliasing.h"
#include "nerf/effects/background.h"
#include "nerf/effects/depth_supervision.h"
#include "nerf/effects/exposure.h"
#include "nerf/effects/masks.h"
#include "nerf/effects/pose_refinement.h"
#include "nerf/effects/robust.h"
#include "nerf/effects/unbounded.h"
#include "nerf/effects/view_dependence.h"

namespace nerf {

// The effects that can be simulated. An effect whose block is present is on; one whose block is
// absent costs nothing.
struct EffectsOptions {
  std::optional<MaskOptions> masks;
  std::optional<UnboundedOptions> unbounded = UnboundedOptions();
  std::optional<ViewDependenceOptions> view_dependence = ViewDependenceOptions();
  std::optional<BackgroundOptions> background;
  std::optional<ExposureOptions> exposure;
  std::optional<RobustOptions> robust;
  std::optional<DepthSupervisionOptions> depth_supervision;
  std::optional<PoseRefinementOptions> pose_refinement;
  std::optional<AntiAliasingOptions> anti_aliasing;

  // Calls visit(descriptor, block) for each effect. This is the only list of all effects.
  template <class Self, class Visitor>
  static void VisitEffects(Self& effects, Visitor&& visit) {
    visit(kMasksEffect, effects.masks);
    visit(kUnboundedEffect, effects.unbounded);
    visit(kViewDependenceEffect, effects.view_dependence);
    visit(kBackgroundEffect, effects.background);
    visit(kExposureEffect, effects.exposure);
    visit(kRobustEffect, effects.robust);
    visit(kDepthSupervisionEffect, effects.depth_supervision);
    visit(kPoseRefinementEffect, effects.pose_refinement);
    visit(kAntiAliasingEffect, effects.anti_aliasing);
  }

  template <class Self, class Visitor>
  static void Options(Self& effects, Visitor&& option) {
    VisitEffects(effects, [&](const EffectDescriptor& effect, auto& block) {
      option(effect.name, block, effect.help);
    });
  }
};

// The descriptors of all effects.
const std::vector<const EffectDescriptor*>& AllEffects();

// The effect with this name or alias; null if there is none.
const EffectDescriptor* FindEffect(const std::string& name);

// The names of all effects.
std::vector<std::string> EffectNames();

// Whether an effect is on.
bool Simulates(const EffectsOptions& effects, const EffectDescriptor& effect);

}  // namespace nerf
