#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// The pixels that the lens covers, y * width + x, ascending: those outside the circle of a fisheye,
// or where a distortion cannot be inverted, see nothing. Nullopt: all are covered.
std::optional<std::vector<std::uint32_t>> PixelsInLens(const Camera& camera);

// The same for one view after another of the same camera. For any thread.
class LensCoverage {
 public:
  std::shared_ptr<const std::optional<std::vector<std::uint32_t>>> Of(const Camera& camera);

 private:
  std::mutex mutex_;
  std::optional<Camera> camera_;
  std::shared_ptr<const std::optional<std::vector<std::uint32_t>>> pixels_;
};

}  // namespace nerf
