#pragma once

#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// The approximations of a rendering.
struct RenderQuality {
  int packet = 1;    // neighbouring pixels that share a proposal: 1, 4 or 16
  int samples = 24;  // per ray, where a proposal network places them
  // Along a ray, radiance is evaluated once per this share of weight, at its middle. 0: for every
  // sample.
  double color_share = 0;
  double stop_transmittance = 1e-4;  // a ray stops where its transmittance is below this

  // The approximations of a quality: 1 is exact, 0 is the fastest that still looks right.
  // Throws InputError if it is not in [0, 1].
  static RenderQuality Of(double quality, const MarchOptions& march,
                          const ProposalOptions& proposal);
};

}  // namespace nerf
