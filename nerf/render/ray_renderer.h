#pragma once

#include <cstdint>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/render/stage_seconds.h"

namespace nerf {

// What rays see.
struct RenderOutput {
  std::vector<float> rgb;      // [R,3] in the encoding that the field was trained in
  std::vector<float> opacity;  // [R] in [0,1]
  std::vector<float> depth;    // [R] expected distance of what was hit, normalized scene units,
                               // inside [near, far]; 0 where opacity is 0: there it has no meaning
  std::int64_t samples = 0;    // points at which the field was evaluated
  StageSeconds seconds;        // nothing where the renderer does not take its stages' time
};

// Anything that turns rays into colours. Rendering changes nothing: it is safe from any thread as
// long as nobody changes the model.
class RayRenderer {
 public:
  virtual ~RayRenderer() = default;
  virtual RenderOutput Render(const RayBatch& rays) const = 0;
};

}  // namespace nerf
