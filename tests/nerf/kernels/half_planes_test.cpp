#include "nerf/kernels/half_planes.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <vector>

#include "nerf/base/random.h"
#include "nerf/kernels/simd_level.h"

namespace nerf::kernels {
namespace {

// Subnormal halves, the largest, and numbers of pixels that do not fill a vector.
TEST(PlanesOfHalves, AreTheHalvesTimesTheScale) {
  for (const std::size_t count : {1u, 15u, 16u, 43u}) {
    std::vector<Eigen::half> halves;
    for (std::size_t i = 0; i < 4 * count; ++i) {
      halves.emplace_back(i == 1 ? 1e-7f : i == 2 ? 65504.0f : RandomFloat(1, 2, i) * 2 - 1);
    }
    std::vector<std::uint16_t> bits(halves.size());
    std::memcpy(bits.data(), halves.data(), 2 * bits.size());
    const std::array<float, 4> scale = {0.5f, 1, 2, 1};
    for (const SimdLevel& level : SimdLevels()) {
      SCOPED_TRACE(level.name);
      const WithSimdLevel use(level);
      std::vector<float> planes(4 * count + 1, -7.0f);
      PlanesOfHalves(bits, scale,
                     {&planes[0], &planes[count], &planes[2 * count], &planes[3 * count]});
      for (std::size_t p = 0; p < count; ++p) {
        for (std::size_t k = 0; k < 4; ++k) {
          EXPECT_EQ(planes[k * count + p], static_cast<float>(halves[4 * p + k]) * scale[k]);
        }
      }
      EXPECT_EQ(planes.back(), -7.0f);  // nothing beyond the last pixel is written
    }
  }
}

}  // namespace
}  // namespace nerf::kernels
