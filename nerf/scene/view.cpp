#include "nerf/scene/view.h"

#include <algorithm>

#include "nerf/base/random.h"
#include "nerf/scene/camera.h"

namespace nerf {

std::int64_t View::CandidateCount() const {
  return valid_pixels.empty() ? PixelCount(camera) : static_cast<std::int64_t>(valid_pixels.size());
}

std::int64_t View::PixelIndex(std::int64_t k) const {
  const std::int64_t candidates = CandidateCount(), stored = StoredCount();
  std::int64_t chosen = k;
  if (stored < candidates) {
    constexpr std::uint64_t kSubsetStream = 0x68656c645f5f5f5full;
    const std::int64_t begin = candidates * k / stored, end = candidates * (k + 1) / stored;
    const std::uint64_t bits = RandomBits(seed, kSubsetStream, static_cast<std::uint64_t>(k));
    chosen = begin + static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(end - begin));
  }
  return valid_pixels.empty() ? chosen : valid_pixels[chosen];
}

std::int64_t View::StoredNear(std::int64_t pixel) const {
  std::int64_t candidate = pixel;
  if (!valid_pixels.empty()) {
    candidate = std::ranges::lower_bound(valid_pixels, static_cast<std::uint32_t>(pixel)) -
                valid_pixels.begin();
    candidate = std::min(candidate, CandidateCount() - 1);
  }
  return candidate * StoredCount() / CandidateCount();
}

}  // namespace nerf
