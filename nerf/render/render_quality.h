#pragma once

#include "nerf/sampling/proposal_options.h"
#include "nerf/sampling/ray_marcher.h"

namespace nerf {

// What a rendering leaves out. Each bound is on its own share of a pixel, in units of the largest
// radiance; the defaults leave nothing out that training does not.
struct RenderQuality {
  int packet = 1;    // pixels, side by side, whose samples a proposal places together: 1, 4, 16
  int samples = 24;  // a ray, where a proposal places them
  double min_weight = 0;             // samples of less weight take on the colour of the next
  double stop_transmittance = 1e-4;  // a ray ends where less light than this gets through

  // The dial: 1 is exact, 0 the fastest whose pictures still look right.
  // Throws sfm::InputError where it is not in [0, 1].
  static RenderQuality Of(double dial, const MarchOptions& march, const ProposalOptions& proposal);
};

}  // namespace nerf
