#include "nerf/synthetic/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nerf/synthetic/hash.h"
#include "nerf/synthetic/scene.h"

namespace nerf::synthetic {
namespace {

using Eigen::Vector3d;

Vector3d RandomPoint(int i) {
  return Vector3d(UnitFromHash(Hash(i, 0, 0, 5)), UnitFromHash(Hash(i, 1, 0, 5)),
                  UnitFromHash(Hash(i, 2, 0, 5))) *
             4 -
         Vector3d::Constant(2);
}

TEST(GradientNoise, VanishesAtLatticePointsAndStaysInRange) {
  EXPECT_EQ(GradientNoise({3, -2, 7}, 1), 0);
  double largest = 0;
  for (int i = 0; i < 20000; ++i) {
    largest = std::max(largest, std::abs(GradientNoise(RandomPoint(i) * 10, 1)));
  }
  EXPECT_LE(largest, 1.0);
  EXPECT_GT(largest, 0.6);
}

TEST(GradientNoise, IsContinuousAcrossCells) {
  for (int i = 0; i < 200; ++i) {
    Vector3d x = RandomPoint(i);
    x.x() = std::round(x.x());
    const Vector3d step(1e-7, 0, 0);
    EXPECT_NEAR(GradientNoise(x - step, 3), GradientNoise(x + step, 3), 1e-5);
  }
}

TEST(FractalNoise, HasSimilarSpreadForAnyNumberOfOctaves) {
  for (const int octaves : {1, 3, 5}) {
    double squares = 0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
      const double value = FractalNoise(RandomPoint(i) * 7, octaves, 2);
      squares += value * value;
    }
    const double deviation = std::sqrt(squares / kPoints);
    EXPECT_GT(deviation, 0.35) << octaves;
    EXPECT_LT(deviation, 0.65) << octaves;
  }
}

TEST(Texture, TheBuiltInOnesAreReflectances) {
  const Scene scene = BuiltInScene();
  for (const Object& object : scene.objects) {
    for (int i = 0; i < 3000; ++i) {
      const Color color = Evaluate(object.material.albedo, RandomPoint(i));
      ASSERT_GE(color.minCoeff(), 0);
      ASSERT_LE(color.maxCoeff(), 1);
    }
  }
}

// A patch of the slab must differ from the same patch shifted.
TEST(Texture, TheSlabDoesNotRepeat) {
  const Texture slab = BuiltInScene().objects.front().material.albedo;
  const auto difference = [&](const Vector3d& shift) {
    double sum = 0;
    for (int i = 0; i < 100; ++i) {
      const Vector3d x(0.05 * (i % 10), 0.05 * (i / 10), 0);
      sum += (Evaluate(slab, x) - Evaluate(slab, x + shift)).matrix().norm();
    }
    return sum / 100;
  };
  EXPECT_EQ(difference({0, 0, 0}), 0);
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      if (x == 0 && y == 0) continue;
      // A period would be a multiple of the cell size of the largest chips, 0.42.
      EXPECT_GT(difference(Vector3d(0.42 * x, 0.42 * y, 0)), 0.05) << x << " " << y;
    }
  }
}

TEST(ColorFromSrgbHex, IsLinear) {
  EXPECT_TRUE(ColorFromSrgbHex(0xffffff).isApprox(Color::Ones(), 1e-6));
  const Color color = ColorFromSrgbHex(0x800000);  // 128/255 is 0.2159 in linear light
  EXPECT_NEAR(color.x(), 0.2159, 1e-4);
  EXPECT_EQ(color.y(), 0);
}

}  // namespace
}  // namespace nerf::synthetic
