#include "nerf/light/environment_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include "nerf/geometry/directions.h"
#include "nerf/image/image_io.h"
#include "nerf/light/lights.h"
#include "nerf/light/spherical_harmonics.h"
#include "tests/support/chi_square.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

using std::numbers::pi;

Image Black(int height) { return Image(2 * height, height, 3, ColorEncoding::kLinear); }

void Light(Image& image, int x, int y, const Color& radiance) {
  for (int c = 0; c < 3; ++c) image.At(x, y)[c] = static_cast<float>(radiance[c]);
}

// A sky with a gradient and a bright spot, different in each channel.
EnvironmentMap SkyWithASun(int height = 32, double sun = 300) {
  Image image = Black(height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * height; ++x) {
      const double up = 1 - (y + 0.5) / height;
      Light(image, x, y, Color(0.2 + 0.3 * up, 0.3 + 0.4 * up, 0.3 + 0.7 * up));
    }
  }
  Light(image, height / 2, height / 4, sun * Color(1, 0.8, 0.7));
  return {image, "sky"};
}

TEST(EnvironmentMap, HasTheDocumentedOrientation) {
  Image image = Black(32);
  Light(image, 10, 0, Color(1, 0, 0));
  for (int x = 0; x < 64; ++x) Light(image, x, 0, Color(1, 0, 0));
  Light(image, 32, 16, Color(0, 1, 0));
  Light(image, 48, 16, Color(0, 0, 1));
  const EnvironmentMap map(image, "axes");
  EXPECT_EQ(map.Radiance(Vector3d::UnitY()).x(), 1);
  EXPECT_EQ(map.Radiance(Vector3d(0.01, -0.01, -1).normalized()).y(), 1);
  EXPECT_EQ(map.Radiance(Vector3d(1, -0.01, 0.01).normalized()).z(), 1);
  EXPECT_TRUE(map.Radiance(-Vector3d::UnitY()).isZero());
}

TEST(EnvironmentMap, WhatResamplingOvershootsIsTheDarkSideOfItsEdge) {
  Image image = Black(32);
  for (float& value : image.pixels) value = 0.5f;
  image.pixels[3] = -1e-5f;
  image.pixels[90] = -0.3f;
  Light(image, 31, 0, Color(9, 9, 9));  // the bright side
  const EnvironmentMap map(image, "resampled");
  EXPECT_EQ(map.At(1, 0).x(), 0.5);
  EXPECT_EQ(map.At(30, 0).x(), 0.5);
  // More than a thousandth of the light is no rounding.
  for (int i = 0; i < 40; ++i) image.pixels[3 * i] = -0.3f;
  EXPECT_THAT(test::InputErrorOf([&] { EnvironmentMap(image, "wrong.exr"); }),
              AllOf(HasSubstr("wrong.exr"), HasSubstr("pixel (0, 0) is -0.3")));
}

TEST(EnvironmentMap, DirectionsMapBackToTheirPixelsAndCoverTheSphere) {
  const EnvironmentMap map = SkyWithASun(16);
  double sum = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      EXPECT_TRUE((map.Radiance(map.Direction(x, y)) == map.At(x, y)).all());
      sum += map.SolidAngle(y);
    }
  }
  EXPECT_NEAR(sum, 4 * pi, 1e-12);
}

TEST(EnvironmentMap, SamplesFollowThePdf) {
  const EnvironmentMap map = SkyWithASun(12, 20);
  const double deviation = test::ChiSquareDeviation(
      [&](std::uint64_t i) { return map.Sample(test::Uniform3(1, i).head<2>())->direction; },
      [&](const Vector3d& d) { return map.Pdf(d); }, 96);
  EXPECT_LT(deviation, 5);
}

TEST(EnvironmentMap, SamplesEstimateTheIrradiance) {
  const EnvironmentMap map = SkyWithASun();
  const Vector3d normal = Vector3d(0.2, 0.9, -0.3).normalized();
  Color sum = Color::Zero();
  constexpr int kDraws = 50000;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const auto sample = map.Sample(test::Uniform3(2, i).head<2>());
    sum += sample->radiance * (std::max(0.0, normal.dot(sample->direction)) / sample->pdf);
  }
  EXPECT_LT(((sum / kDraws - map.Irradiance(normal)) / map.Irradiance(normal)).abs().maxCoeff(),
            0.02);
}

TEST(EnvironmentMap, SamplesOfASingleBrightPixelAreInsideIt) {
  Image image = Black(16);
  Light(image, 31, 15, Color(0, 0, 7));  // at the bottom pole and the seam
  const EnvironmentMap map(image, "one");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto sample = map.Sample(test::Uniform3(3, i).head<2>());
    ASSERT_TRUE(sample);
    ASSERT_EQ(sample->radiance.z(), 7);
    ASSERT_EQ(map.Radiance(sample->direction).z(), 7);
    // The density is uniform over the solid angle of the pixel.
    ASSERT_NEAR(sample->pdf * map.SolidAngle(15), 1, 1e-9);
  }
  for (const double u : {0.0, 1 - 0x1p-53}) {
    EXPECT_EQ(map.Sample({u, u})->radiance.z(), 7);
  }
}

TEST(EnvironmentMap, BlackPixelsAreNeverSampled) {
  for (const int x : {0, 5, 31}) {
    for (const int y : {0, 7, 15}) {
      Image image = Black(16);
      Light(image, x, y, Color::Constant(0.1));
      const EnvironmentMap map(image, "one");
      for (const double u : {0.0, 0.3, 1 - 0x1p-53}) {
        for (const double v : {0.0, 0.7, 1 - 0x1p-53}) EXPECT_GT(map.Sample({u, v})->pdf, 0);
      }
    }
  }
}

TEST(EnvironmentMap, ABlackMapHasNoSamples) {
  const EnvironmentMap map(Black(8), "black");
  EXPECT_FALSE(map.Sample({0.5, 0.5}));
  EXPECT_EQ(map.Pdf(Vector3d::UnitX()), 0);
  EXPECT_TRUE(map.Irradiance(Vector3d::UnitX()).isZero());
}

TEST(EnvironmentMap, AUniformMapIsUniformAtThePoles) {
  const EnvironmentMap map = EnvironmentMap::Uniform(Color::Ones());
  EXPECT_NEAR(map.Pdf(Vector3d::UnitY()), 1 / (4 * pi), 1e-9);
  EXPECT_NEAR(map.Pdf(-Vector3d::UnitY()), 1 / (4 * pi), 1e-9);
  for (const Vector3d& n : {Vector3d(0, 1, 0), Vector3d(1, 0, 0), Vector3d(0, -0.6, 0.8)}) {
    EXPECT_NEAR(map.Irradiance(n).x(), pi, 1e-2);
  }
}

TEST(EnvironmentMap, RejectsInvalidFilesByName) {
  const test::ScratchFolder scratch;
  const auto error = [&](const Image& image) {
    WriteImage(scratch.path() / "map.exr", image);
    return test::InputErrorOf([&] { EnvironmentMap::Read(scratch.path() / "map.exr"); });
  };
  EXPECT_THAT(error(Image(30, 10, 3, ColorEncoding::kLinear)),
              AllOf(HasSubstr("map.exr"), HasSubstr("30 x 10"), HasSubstr("twice as wide")));
  Image image = Black(8);
  Light(image, 3, 2, Color(0, -0.5, 0));
  EXPECT_THAT(error(image), AllOf(HasSubstr("map.exr"), HasSubstr("(3, 2)"), HasSubstr("-0.5")));
  Light(image, 3, 2, Color(0, std::numeric_limits<double>::quiet_NaN(), 0));
  EXPECT_THAT(test::InputErrorOf([&] { EnvironmentMap(image, "map.exr"); }), HasSubstr("(3, 2)"));
  EXPECT_THAT(test::InputErrorOf([&] { EnvironmentMap::Read(scratch.path() / "no.hdr"); }),
              HasSubstr("no.hdr"));
}

TEST(PointLight, FallsOffWithTheSquareOfTheDistance) {
  const PointLight light{{0, 0, 3}, Color(1, 2, 9)};
  const IncidentLight near = IncidentFrom(light, {0, 0, 2});
  const IncidentLight far = IncidentFrom(light, {0, 0, 0});
  EXPECT_TRUE(far.to_light.isApprox(Vector3d::UnitZ()));
  EXPECT_NEAR(far.distance, 3, 1e-12);
  EXPECT_NEAR(near.irradiance.z(), 9, 1e-12);
  EXPECT_NEAR(far.irradiance.z(), 1, 1e-12);
}

TEST(SphericalHarmonics, AreOrthonormal) {
  const EnvironmentMap grid(Black(64), "grid");
  double product[9][9] = {};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const auto Y = SphericalHarmonics(grid.Direction(x, y));
      for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 9; ++j) product[i][j] += Y[i] * Y[j] * grid.SolidAngle(y);
      }
    }
  }
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) EXPECT_NEAR(product[i][j], i == j, 1e-3) << i << " " << j;
  }
}

TEST(ShIrradiance, IsExactForRadianceOfLowDegree) {
  Image image = Black(64);
  const EnvironmentMap grid(image, "grid");
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Vector3d d = grid.Direction(x, y);
      Light(image, x, y, Color(1 + d.x(), 2 + d.y() * d.z(), 1 + d.z() * d.z()));
    }
  }
  const ShError error = ShIrradianceError(EnvironmentMap(image, "smooth"), 100);
  EXPECT_LT(error.largest, 1e-3);
}

TEST(ShIrradiance, HasASmallErrorForASmallBrightLight) {
  const ShError error = ShIrradianceError(SkyWithASun(), 200);
  std::cout << "spherical harmonics, a sun in the sky: mean error " << 100 * error.mean
            << " %, largest " << 100 * error.largest << " % of the mean irradiance\n";
  EXPECT_LT(error.mean, 0.1);
  EXPECT_GT(error.largest, error.mean);
}

TEST(ShIrradiance, HasASmallErrorForCapturedEnvironments) {
  for (const char* name : {"studio_small_03_1k.hdr", "venice_sunset_1k.hdr"}) {
    const auto map = EnvironmentMap::Read(std::string(NERF_TEST_DATA) + "/environments/" + name);
    const ShError error = ShIrradianceError(map, 64);
    std::cout << "spherical harmonics, " << name << ": mean error " << 100 * error.mean
              << " %, largest " << 100 * error.largest << " % of the mean irradiance\n";
    EXPECT_LT(error.mean, 0.1);  // bright soft boxes in a dark studio are the hardest case
  }
}

}  // namespace
}  // namespace nerf
