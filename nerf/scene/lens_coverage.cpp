#include "nerf/scene/lens_coverage.h"

#include "nerf/scene/camera.h"

namespace nerf {
namespace {

bool IsCovered(const Camera& camera, int x, int y) {
  return DirectionFromPixel(camera, {x + 0.5, y + 0.5}).has_value();
}

// What a lens covers has no holes, so the border tells.
bool CoversBorder(const Camera& camera) {
  for (int x = 0; x < camera.width; ++x) {
    if (!IsCovered(camera, x, 0) || !IsCovered(camera, x, camera.height - 1)) return false;
  }
  for (int y = 0; y < camera.height; ++y) {
    if (!IsCovered(camera, 0, y) || !IsCovered(camera, camera.width - 1, y)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> PixelsInLens(const Camera& camera) {
  std::vector<std::uint32_t> covered;
  if (CoversBorder(camera)) return covered;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (!IsCovered(camera, x, y)) continue;
      covered.push_back(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width) +
                        static_cast<std::uint32_t>(x));
    }
  }
  return covered;
}

}  // namespace nerf
