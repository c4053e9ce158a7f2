#pragma once

#include <cmath>

#include "nerf/light/environment_map.h"

namespace nerf::test {

// Soft light from above, a wide warm glow on one side, a cool one on the other.
inline EnvironmentMap SmoothEnvironment() {
  Image image(256, 128, 3, ColorEncoding::kLinear);
  const EnvironmentMap grid(image, "grid");
  const Eigen::Vector3d warm = Eigen::Vector3d(-0.8, 0.5, 0.6).normalized();
  const Eigen::Vector3d cool = Eigen::Vector3d(0.9, 0.3, 0.2).normalized();
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      const Eigen::Vector3d d = grid.Direction(x, y);
      const Color radiance = Color(0.25, 0.3, 0.35) * (1 + d.y()) +
                             Color(2.0, 1.4, 0.8) * std::exp(6 * (d.dot(warm) - 1)) +
                             Color(0.5, 0.8, 1.4) * std::exp(4 * (d.dot(cool) - 1));
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = static_cast<float>(radiance[c]);
    }
  }
  return {image, "smooth"};
}

}  // namespace nerf::test
