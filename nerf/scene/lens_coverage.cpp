#include "nerf/scene/lens_coverage.h"

#include <algorithm>
#include <utility>

#include "nerf/base/parallel.h"
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

// The last covered pixel of a row from one that is covered towards one that may not be.
int LastCovered(const Camera& camera, int y, int from, int to) {
  if (IsCovered(camera, to, y)) return to;
  while (std::abs(to - from) > 1) {
    const int middle = (from + to) / 2;
    (IsCovered(camera, middle, y) ? from : to) = middle;
  }
  return from;
}

// The first and last covered pixel of a row, which reaches out from the principal point. Asking
// each pixel would take seconds: where a distortion has no inverse, the search for it is long.
std::pair<int, int> CoveredOf(const Camera& camera, int y) {
  const int middle = std::clamp(static_cast<int>(PrincipalPoint(camera).x()), 0, camera.width - 1);
  if (!IsCovered(camera, middle, y)) return {0, -1};
  return {LastCovered(camera, y, middle, 0), LastCovered(camera, y, middle, camera.width - 1)};
}

}  // namespace

std::optional<std::vector<std::uint32_t>> PixelsInLens(const Camera& camera) {
  if (CoversBorder(camera)) return std::nullopt;
  std::vector<std::pair<int, int>> rows(camera.height);
  ParallelForEach(camera.height,
                  [&](std::int64_t y) { rows[y] = CoveredOf(camera, static_cast<int>(y)); });
  std::vector<std::uint32_t> covered;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = rows[y].first; x <= rows[y].second; ++x) {
      covered.push_back(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width) +
                        static_cast<std::uint32_t>(x));
    }
  }
  return covered;
}

std::shared_ptr<const std::optional<std::vector<std::uint32_t>>> LensCoverage::Of(
    const Camera& camera) {
  const std::lock_guard lock(mutex_);
  if (camera_ != camera) {
    pixels_ =
        std::make_shared<const std::optional<std::vector<std::uint32_t>>>(PixelsInLens(camera));
    camera_ = camera;
  }
  return pixels_;
}

}  // namespace nerf
