#include "nerf/relight/environment_light.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

using std::numbers::pi;

torch::Tensor DirectionRows(int count) {
  torch::Tensor directions = torch::empty({count, 3});
  for (int d = 0; d < count; ++d) {
    const Eigen::Vector3f direction = FibonacciDirection(d, count).cast<float>();
    for (int k = 0; k < 3; ++k) directions[d][k] = direction[k];
  }
  return directions;
}

EnvironmentMap MapWithLamp(int x, int y, float radiance) {
  Image image(64, 32, 3, ColorEncoding::kLinear);
  for (float& value : image.pixels) value = 0.25f;
  for (int c = 0; c < 3; ++c) image.At(x, y)[c] = radiance;
  return {std::move(image), "test"};
}

// The conventions of relight_totem: u = 1/2 - atan2(y, x) / (2 pi), v = acos(z) / pi.
TEST(EnvironmentLight, WorldWithZUpFindsItsPixels) {
  const EnvironmentMap map = MapWithLamp(0, 0, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction = FibonacciDirection(i, 200);
    const double u = 0.5 - std::atan2(direction.y(), direction.x()) / (2 * pi);
    const double v = std::acos(direction.z()) / pi;
    const int x = std::min(63, static_cast<int>(u * 64)),
              y = std::min(31, static_cast<int>(v * 32));
    const Eigen::Vector3d centre = map.Direction(x, y);
    // Within half a texel.
    EXPECT_LT(std::acos(std::min(1.0, centre.dot(MapFromZUpWorld() * direction))), 0.75 * pi / 32);
  }
  EXPECT_NEAR(MapFromZUpWorld().determinant(), 1, 1e-12);
}

// Row 53: one texel of 1e6 is neither lost nor doubled.
TEST(EnvironmentLight, KeepsThePowerOfTheMap) {
  for (const int y : {1, 7, 16, 30}) {
    const EnvironmentMap map = MapWithLamp(11, y, 1e6f);
    double power = 0;
    for (int row = 0; row < map.height(); ++row) {
      for (int x = 0; x < map.width(); ++x) power += map.At(x, row)[0] * map.SolidAngle(row);
    }
    const torch::Tensor radiance =
        RadianceFrom(map, DirectionRows(128), Eigen::Matrix3d::Identity());
    // Each direction stands for the same solid angle, but for the texels at its border.
    EXPECT_NEAR(radiance.select(1, 0).sum().item<double>() * 4 * pi / 128 / power, 1, 0.35) << y;
    EXPECT_EQ((radiance.select(1, 0) > 1e3).sum().item<int>(), 1) << y;
  }
}

TEST(EnvironmentLight, AUniformMapIsUniform) {
  const torch::Tensor radiance = RadianceFrom(EnvironmentMap::Uniform(Color(0.5, 1, 2)),
                                              DirectionRows(512), MapFromZUpWorld());
  const torch::Tensor expected = torch::tensor({0.5f, 1.0f, 2.0f}).expand({512, 3});
  EXPECT_LT((radiance - expected).abs().max().item<float>(), 1e-6f);
}

// A map turned by a whole circle is the same map.
TEST(EnvironmentLight, TurnsAsTheDirectionsDo) {
  const EnvironmentMap map = MapWithLamp(20, 12, 50);
  const torch::Tensor directions = DirectionRows(256);
  const torch::Tensor before = RadianceFrom(map, directions, Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d whole =
      Eigen::AngleAxisd(2 * pi, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_LT((RadianceFrom(map, directions, whole) - before).abs().max().item<float>(), 1e-3f);
}

}  // namespace
}  // namespace nerf
