#include "nerf/effects/exposure_fit.h"

#include <cstddef>

namespace nerf {

std::array<float, 3> FitGains(std::span<const float> rendered, std::span<const float> photograph,
                              ColorEncoding encoding) {
  std::array<double, 3> both{}, own{};
  for (std::size_t i = 0; i < photograph.size(); ++i) {
    if (encoding == ColorEncoding::kSrgb && (photograph[i] <= 0 || photograph[i] >= 1)) continue;
    both[i % 3] += static_cast<double>(rendered[i]) * static_cast<double>(photograph[i]);
    own[i % 3] += static_cast<double>(rendered[i]) * static_cast<double>(rendered[i]);
  }
  std::array<float, 3> gains = {1, 1, 1};
  for (int c = 0; c < 3; ++c) {
    if (both[c] > 0 && own[c] > 0) gains[c] = static_cast<float>(both[c] / own[c]);
  }
  return gains;
}

void ApplyGains(const std::array<float, 3>& gains, std::span<float> rgb) {
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] *= gains[i % 3];
}

}  // namespace nerf
