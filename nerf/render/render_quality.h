#pragma once

#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// What a rendering leaves out.
struct RenderQuality {
  int packet = 1;    // pixels, side by side, whose samples a proposal places together: 1, 4, 16
  int samples = 24;  // a ray, where a proposal places them
  // Weight that one colour stands for: along a ray only the samples in the middle of each such
  // share of its weight get a colour. 0: each gets its own.
  double color_share = 0;
  double stop_transmittance = 1e-4;  // a ray ends where less light than this gets through

  // The dial: 1 is exact, 0 the fastest whose pictures still look right.
  // Throws InputError where it is not in [0, 1].
  static RenderQuality Of(double dial, const MarchOptions& march, const ProposalOptions& proposal);
};

}  // namespace nerf
