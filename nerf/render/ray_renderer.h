#pragma once

#include <cstdint>
#include <vector>

#include "nerf/geometry/rays.h"
#include "nerf/render/stage_seconds.h"

namespace nerf {

// The pixels of a batch of rays.
struct RenderOutput {
  std::vector<float> rgb;      // [R,3] in the encoding of the field
  std::vector<float> opacity;  // [R] in [0,1]
  std::vector<float> depth;    // [R] expected distance, normalized units, in [near, far];
                               // 0 where opacity is 0, where it is undefined
  std::int64_t samples = 0;    // points at which the field was evaluated
  StageSeconds seconds;        // 0 if the renderer does not time its stages
};

// Renders rays. Thread-safe as long as the model does not change.
class RayRenderer {
 public:
  virtual ~RayRenderer() = default;
  // Throws std::invalid_argument naming the first invalid ray.
  virtual RenderOutput Render(const RayBatch& rays) const = 0;
};

}  // namespace nerf
