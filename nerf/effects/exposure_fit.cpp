#include "nerf/effects/exposure_fit.h"

#include <cstddef>

namespace nerf {

std::array<float, 3> FitGains(std::span<const float> rendered, std::span<const float> photograph,
                              std::span<const float> background, ColorEncoding encoding) {
  std::array<double, 3> both{}, own{};
  for (std::size_t i = 0; i < photograph.size(); ++i) {
    if (encoding == ColorEncoding::kSrgb && (photograph[i] <= 0 || photograph[i] >= 1)) continue;
    const double behind = background.empty() ? 0.0 : static_cast<double>(background[i]);
    const double of_scene = static_cast<double>(rendered[i]) - behind;
    both[i % 3] += of_scene * (static_cast<double>(photograph[i]) - behind);
    own[i % 3] += of_scene * of_scene;
  }
  std::array<float, 3> gains = {1, 1, 1};
  for (int c = 0; c < 3; ++c) {
    if (both[c] > 0 && own[c] > 0) gains[c] = static_cast<float>(both[c] / own[c]);
  }
  return gains;
}

void ApplyGains(const std::array<float, 3>& gains, std::span<const float> background,
                std::span<float> rgb) {
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const float behind = background.empty() ? 0.0f : background[i];
    rgb[i] = gains[i % 3] * (rgb[i] - behind) + behind;
  }
}

std::vector<float> BackgroundContribution(std::span<const float> opacity,
                                          std::span<const float> background) {
  std::vector<float> contribution(3 * opacity.size());
  for (std::size_t i = 0; i < contribution.size(); ++i) {
    contribution[i] = (1 - opacity[i / 3]) * background[background.size() == 3 ? i % 3 : i];
  }
  return contribution;
}

void FitExposure(std::span<float> rgb, std::span<const float> opacity,
                 std::span<const float> photograph, std::span<const float> background,
                 ColorEncoding encoding) {
  const std::vector<float> behind = BackgroundContribution(opacity, background);
  ApplyGains(FitGains(rgb, photograph, behind, encoding), behind, rgb);
}

}  // namespace nerf
