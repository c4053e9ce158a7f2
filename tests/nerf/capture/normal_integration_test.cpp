#include "nerf/capture/normal_integration.h"

#include <gtest/gtest.h>

#include <cmath>

namespace nerf {
namespace {

void Store(Image& normal, int x, int y, double nx, double ny, double nz) {
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  float* pixel = normal.At(x, y);
  pixel[0] = static_cast<float>(nx / length);
  pixel[1] = static_cast<float>(ny / length);
  pixel[2] = static_cast<float>(nz / length);
}

TEST(IntegrateNormals, ReconstructsAPlane) {
  Image normal(20, 15, 3, ColorEncoding::kLinear);
  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 20; ++x) Store(normal, x, y, -0.3, 0.5, 1);
  }
  const Image height = IntegrateNormals(normal);
  // z = 0.3 x - 0.5 y with y up, so a row further down is 0.5 higher.
  EXPECT_NEAR(*height.At(19, 0) - *height.At(0, 0), 19 * 0.3, 1e-4);
  EXPECT_NEAR(*height.At(0, 14) - *height.At(0, 0), 14 * 0.5, 1e-4);
}

// A spherical cap with a hole; heights are compared up to a constant.
TEST(IntegrateNormals, ReconstructsASphereWithAHole) {
  constexpr int kRadius = 60;
  Image normal(2 * kRadius + 1, 2 * kRadius + 1, 3, ColorEncoding::kLinear);
  const auto z_at = [](int x, int y) {
    const int dx = x - kRadius;
    const int dy = y - kRadius;
    return std::sqrt(std::max(0, kRadius * kRadius - dx * dx - dy * dy));
  };
  for (int y = 0; y < normal.height; ++y) {
    for (int x = 0; x < normal.width; ++x) {
      const double z = z_at(x, y);
      if (z < 0.5 * kRadius || (std::abs(x - 70) < 4 && std::abs(y - 50) < 4)) continue;
      Store(normal, x, y, x - kRadius, kRadius - y, z);
    }
  }
  const Image height = IntegrateNormals(normal);
  EXPECT_TRUE(std::isnan(*height.At(70, 50)));
  EXPECT_TRUE(std::isnan(*height.At(0, 0)));
  const double shift = *height.At(kRadius, kRadius) - z_at(kRadius, kRadius);
  double worst = 0;
  for (int y = 0; y < normal.height; ++y) {
    for (int x = 0; x < normal.width; ++x) {
      if (!std::isnan(*height.At(x, y))) {
        worst = std::max(worst, std::abs(*height.At(x, y) - shift - z_at(x, y)));
      }
    }
  }
  EXPECT_LT(worst, 0.01 * kRadius);
}

TEST(IntegrateNormals, SeparatePartsHaveAMeanOfZero) {
  Image normal(9, 4, 3, ColorEncoding::kLinear);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 9; ++x) {
      if (x != 4) Store(normal, x, y, x < 4 ? -1 : 0, 0, 1);
    }
  }
  const Image height = IntegrateNormals(normal);
  EXPECT_NEAR(*height.At(0, 0), -1.5, 1e-4);
  EXPECT_NEAR(*height.At(3, 3), 1.5, 1e-4);
  EXPECT_NEAR(*height.At(7, 2), 0, 1e-4);
}

}  // namespace
}  // namespace nerf
