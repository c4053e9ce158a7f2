#pragma once

#include <optional>

#include "nerf/effects/background_map.h"
#include "nerf/effects/depth.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/effects/footprint.h"
#include "nerf/effects/masks.h"
#include "nerf/effects/poses_options.h"
#include "nerf/effects/robust.h"
#include "nerf/effects/unbounded.h"
#include "nerf/effects/view.h"

namespace nerf {

// The effects that a scene may call for, in the order in which light meets them. A block that is
// there is an effect that is simulated; one that is not there costs nothing.
struct EffectsOptions {
  std::optional<PosesOptions> poses;
  std::optional<UnboundedOptions> unbounded = UnboundedOptions();
  std::optional<FootprintOptions> footprint;
  std::optional<ViewOptions> view = ViewOptions();
  std::optional<BackgroundOptions> background;
  std::optional<ExposureOptions> exposure;
  std::optional<MaskOptions> masks;
  std::optional<RobustOptions> robust;
  std::optional<DepthOptions> depth;

  void Check() const;
};

}  // namespace nerf
