#include "nerf/effects/background_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

namespace nerf {
namespace {

struct Rays {
  std::vector<std::int64_t> photograph;
  std::vector<float> direction, rgb;
};

// The direction at a polar angle (down) and a longitude (around), each as a fraction of its range.
std::array<float, 3> DirectionAt(double down, double around) {
  const double polar = down * std::numbers::pi, longitude = (2 * around - 1) * std::numbers::pi;
  return {static_cast<float>(std::sin(polar) * std::cos(longitude)),
          static_cast<float>(std::sin(polar) * std::sin(longitude)),
          static_cast<float>(std::cos(polar))};
}

// Adds the rays of a photograph of a belt of polar angles: at least four for each texel of a map.
void Show(std::int64_t photograph, double from, double to, int rows,
          const std::function<float(double down, double around)>& grey, Rays& rays) {
  const int down_steps = static_cast<int>(2 * rows * (to - from)), around_steps = 4 * rows;
  for (int i = 0; i < down_steps; ++i) {
    for (int k = 0; k < around_steps; ++k) {
      const double down = from + (to - from) * (i + 0.5) / down_steps;
      const double around = (k + 0.5) / around_steps;
      const auto direction = DirectionAt(down, around);
      rays.photograph.push_back(photograph);
      rays.direction.insert(rays.direction.end(), direction.begin(), direction.end());
      rays.rgb.insert(rays.rgb.end(), 3, grey(down, around));
    }
  }
}

float RadianceAt(const BackgroundMap& map, double down, double around) {
  std::vector<float> rgb(3);
  map.Radiance(DirectionAt(down, around), rgb);
  return rgb[0];
}

BackgroundMap Initialized(const Rays& rays, int rows,
                          ColorEncoding encoding = ColorEncoding::kSrgb) {
  BackgroundMap map{rows, encoding, {}};
  InitializeBackground(rays.photograph, rays.direction, rays.rgb, map);
  return map;
}

float Bright(double, double) { return 0.7f; }
float Dark(double, double) { return 0.1f; }

TEST(InitializeBackground, TakesTheColourThatMostPhotographsAgreeOn) {
  for (const int rows : {8, 64}) {
    for (const auto encoding : {ColorEncoding::kSrgb, ColorEncoding::kLinear}) {
      // Each of the other photographs shows another colour: a passer-by.
      Rays rays;
      for (const int sky : {0, 3}) Show(sky, 0, 1, rows, Bright, rays);
      for (const int other : {1, 2, 4}) {
        Show(
            other, 0, 1, rows, [&](double, double) { return 0.11f * static_cast<float>(other); },
            rays);
      }
      const BackgroundMap map = Initialized(rays, rows, encoding);
      for (const double down : {0.2, 0.5, 0.8}) {
        EXPECT_NEAR(RadianceAt(map, down, 0.3), 0.7f, 1e-3f);
      }
    }
  }
}

TEST(InitializeBackground, ShowsDetailThatIsFinerThanTheCoarseMap) {
  const auto clouds = [](double, double around) {
    return std::fmod(around * 32, 1.0) < 0.5 ? 0.4f : 0.6f;
  };
  Rays rays;
  for (const int photograph : {0, 1}) Show(photograph, 0.3, 0.7, 64, clouds, rays);
  const BackgroundMap map = Initialized(rays, 64);
  for (const double cloud : {3.0, 11.0, 20.0}) {
    EXPECT_NEAR(RadianceAt(map, 0.5, (cloud + 0.25) / 32), 0.4f, 0.02f);
    EXPECT_NEAR(RadianceAt(map, 0.5, (cloud + 0.75) / 32), 0.6f, 0.02f);
  }
}

// What a single photograph shows may be an object in front of the sky.
TEST(InitializeBackground, ExtrapolatesTheSkyWhereOnlyOnePhotographLooks) {
  for (const int rows : {16, 64}) {
    Rays rays;
    for (const int photograph : {0, 1}) Show(photograph, 0, 0.5, rows, Bright, rays);
    Show(2, 0.5, 0.7, rows, Dark, rays);
    const BackgroundMap map = Initialized(rays, rows);
    for (const double down : {0.6, 0.9}) EXPECT_NEAR(RadianceAt(map, down, 0.3), 0.7f, 1e-3f);
  }
}

// Each texel of the finer map is seen by one photograph only, of the coarser one by both.
TEST(InitializeBackground, InterpolatesTheCoarserMapWhereNoneAgree) {
  const auto smooth = [](double down, double around) {
    return static_cast<float>(0.5 + 0.2 * std::sin(2 * std::numbers::pi * around) +
                              0.2 * (down - 0.5));
  };
  for (const int rows : {17, 32, 33}) {
    Rays rays;
    for (const int photograph : {0, 1}) Show(photograph, 0.2, 0.8, 64, smooth, rays);
    const BackgroundMap fine = Initialized(rays, rows), coarse = Initialized(rays, rows / 2);
    Rays apart = rays;
    for (std::size_t r = 0; r < apart.photograph.size(); ++r) {
      const auto texels =
          BackgroundMap::TexelsOf(std::span(apart.direction).subspan(3 * r).first<3>(), rows);
      const auto nearest = std::ranges::max_element(texels.weight) - texels.weight.begin();
      apart.photograph[r] = texels.index[nearest] % 2;
    }
    const BackgroundMap filled = Initialized(apart, rows);
    for (const double down : {0.35, 0.5, 0.65}) {
      for (const double around : {0.1, 0.4, 0.72}) {
        EXPECT_NEAR(RadianceAt(fine, down, around), smooth(down, around), 0.02f);
        EXPECT_NEAR(RadianceAt(filled, down, around), smooth(down, around), 0.04f);
        EXPECT_NEAR(RadianceAt(filled, down, around), RadianceAt(coarse, down, around), 0.03f);
      }
    }
  }
}

TEST(InitializeBackground, TakesTheMedianWhereExposuresDiffer) {
  Rays rays;
  for (const int photograph : {0, 1, 2}) {
    Show(
        photograph, 0, 1, 64,
        [&](double down, double) {
          // At the zenith two of them agree by chance.
          return down < 0.05 ? 0.9f : 0.2f + 0.3f * static_cast<float>(photograph);
        },
        rays);
  }
  EXPECT_NEAR(RadianceAt(Initialized(rays, 64), 0.4, 0.6), 0.5f, 1e-3f);
  EXPECT_NEAR(RadianceAt(Initialized(rays, 16), 0.4, 0.6), 0.5f, 1e-3f);
}

TEST(InitializeBackground, DoesNotDependOnTheUnitOfLinearLight) {
  for (const float unit : {0.1f, 1000.0f}) {
    Rays rays;
    for (const int sky : {0, 1}) {
      Show(
          sky, 0, 1, 16, [&](double, double) { return 0.7f * unit; }, rays);
    }
    for (const int other : {2, 3, 4}) {
      Show(
          other, 0, 1, 16, [&](double, double) { return 0.1f * unit * static_cast<float>(other); },
          rays);
    }
    EXPECT_NEAR(RadianceAt(Initialized(rays, 16, ColorEncoding::kLinear), 0.4, 0.6), 0.7f * unit,
                1e-3f * unit);
  }
}

TEST(InitializeBackground, StaysFiniteForBlackAndWhite) {
  for (const float grey : {0.0f, 1.0f}) {
    Rays rays;
    for (const int photograph : {0, 1}) {
      Show(
          photograph, 0, 1, 8, [&](double, double) { return grey; }, rays);
    }
    for (const float raw : Initialized(rays, 8).raw) EXPECT_LT(std::fabs(raw), 10);
  }
}

TEST(InitializeBackground, IsGreyWithoutAnyRays) {
  for (const int rows : {8, 64}) {
    EXPECT_EQ(Initialized({}, rows).raw, std::vector<float>(6 * rows * rows, 0.0f));
  }
}

}  // namespace
}  // namespace nerf
