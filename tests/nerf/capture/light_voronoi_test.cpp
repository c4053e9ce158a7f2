#include "nerf/capture/light_voronoi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "nerf/geometry/directions.h"
#include "tests/support/input_error_of.h"

namespace nerf {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

using std::numbers::pi;

std::vector<DirectionalLight> LightsAt(const std::vector<Vector3d>& directions) {
  std::vector<DirectionalLight> lights;
  for (const Vector3d& d : directions) lights.push_back({d.normalized()});
  return lights;
}

std::vector<DirectionalLight> GridOfLights(int rows, int columns) {
  std::vector<Vector3d> directions;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double theta = pi * (r + 0.5) / rows;
      const double phi = 2 * pi * c / columns;
      directions.push_back(
          {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)});
    }
  }
  return LightsAt(directions);
}

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(LightVoronoi, CellsOfSymmetricLightsAreEqual) {
  const std::vector<Vector3d> faces = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                       {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  }
  for (const auto& directions : {faces, corners}) {
    const LightVoronoi cells(LightsAt(directions), 256);
    const auto angles = cells.SolidAngles();
    EXPECT_NEAR(Sum(angles), 4 * pi, 1e-6);
    const double expected = 4 * pi / static_cast<double>(directions.size());
    for (const double angle : angles) EXPECT_NEAR(angle, expected, 0.01 * expected);
  }
}

// Two symmetric lights have cells of the same size.
TEST(LightVoronoi, CellsMeetHalfwayBetweenLights) {
  const LightVoronoi cells(LightsAt({{0, 1, 0},
                                     {std::sin(1.0), std::cos(1.0), 0},
                                     {-std::sin(1.0), std::cos(1.0), 0},
                                     {0, -1, 0}}),
                           256);
  const auto angles = cells.SolidAngles();
  EXPECT_NEAR(angles[1], angles[2], 1e-9);
  EXPECT_NEAR(Sum(angles), 4 * pi, 1e-6);
}

TEST(LightVoronoi, GridCellsHaveTheSolidAngleOfTheSinTerm) {
  constexpr int kRows = 12;
  constexpr int kColumns = 24;
  const LightVoronoi cells(GridOfLights(kRows, kColumns), 240);
  EXPECT_TRUE(cells.on_a_grid());
  const auto angles = cells.SolidAngles();
  EXPECT_NEAR(Sum(angles), 4 * pi, 1e-6);
  for (int r = 0; r < kRows; ++r) {
    const double theta = pi * (r + 0.5) / kRows;
    const double sin_term = std::sin(theta) * (pi / kRows) * (2 * pi / kColumns);
    for (int c = 0; c < kColumns; ++c) {
      EXPECT_NEAR(angles[r * kColumns + c], sin_term, 0.004 * sin_term) << r << " " << c;
    }
  }
}

TEST(LightVoronoi, AFibonacciLatticeIsNotAGrid) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < 100; ++i) directions.push_back(FibonacciDirection(i, 100));
  const LightVoronoi cells(LightsAt(directions), 128);
  EXPECT_FALSE(cells.on_a_grid());
  for (const double angle : cells.SolidAngles()) EXPECT_NEAR(angle, 4 * pi / 100, 0.02);
}

// All power of a small bright light, wherever it is, is assigned to a light.
TEST(LightVoronoi, ASmallBrightLightIsNeverLostBetweenCells) {
  const auto lights = GridOfLights(6, 12);
  const LightVoronoi cells(lights, 64);
  for (int x = 0; x < 128; x += 7) {
    for (int y = 0; y < 64; y += 5) {
      Image image(128, 64, 3, ColorEncoding::kLinear);
      std::fill_n(image.At(x, y), 3, 1000.0f);
      const EnvironmentMap map(image, "sun");
      const auto weights = cells.Integrate(map);
      Color sum = Color::Zero();
      for (const Color& weight : weights) sum += weight;
      ASSERT_NEAR(sum.x(), 1000 * map.SolidAngle(y), 1e-9 * 1000);
    }
  }
}

TEST(LightVoronoi, RotatesTheEnvironmentCounterClockwise) {
  // Ahead (-z), left (-x), behind, right: counter-clockwise as seen from above.
  const LightVoronoi cells(
      LightsAt({{0, 0, -1}, {-1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}), 64);
  Image image(128, 64, 3, ColorEncoding::kLinear);
  std::fill_n(image.At(64, 32), 3, 1.0f);  // ahead
  const EnvironmentMap map(image, "ahead");
  for (int quarter = 0; quarter < 4; ++quarter) {
    const auto weights = cells.Integrate(map, 90.0 * quarter);
    for (int light = 0; light < 6; ++light) {
      EXPECT_EQ(weights[light].x() > 0, light == quarter) << quarter << " " << light;
    }
  }
  EXPECT_TRUE((cells.Integrate(map, -90)[3] > 0).all());
  EXPECT_TRUE((cells.Integrate(map, 360)[0] > 0).all());
}

// A map with radiance 1 below y = `above`, and another radiance above.
EnvironmentMap LitBelow(double above, float radiance_above) {
  Image image(128, 64, 3, ColorEncoding::kLinear);
  const EnvironmentMap grid(image, "grid");
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      std::fill_n(image.At(x, y), 3, grid.Direction(x, y).y() < above ? 1.0f : radiance_above);
    }
  }
  return {image, "below"};
}

std::vector<DirectionalLight> Lattice(int count, double lowest) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const Vector3d d = FibonacciDirection(i, count);
    if (d.z() >= lowest) directions.push_back({d.x(), d.z(), -d.y()});
  }
  return LightsAt(directions);
}

// No image shows the subject lit from below, so that no image may be used for such light.
TEST(LightVoronoi, IgnoresDirectionsFarFromAllLights) {
  const LightVoronoi dome(Lattice(400, 0.3), 64);  // above 17 degrees
  const EnvironmentMap below = LitBelow(-0.3, 0);
  for (const Color& weight : dome.Integrate(below)) EXPECT_TRUE(weight.isZero(0));
  EXPECT_EQ(dome.UncoveredFraction(below), 1);
  EXPECT_NEAR(dome.UncoveredFraction(LitBelow(2, 1)), 0.5, 0.15);
  // Light from near the lights is kept.
  Image image(128, 64, 3, ColorEncoding::kLinear);
  std::fill_n(image.At(3, 5), 3, 1.0f);
  const EnvironmentMap sun(image, "sun");
  EXPECT_EQ(dome.UncoveredFraction(sun), 0);
  EXPECT_EQ(dome.UncoveredFraction(EnvironmentMap::Uniform(Color::Zero())), 0);
}

TEST(LightVoronoi, LightsOnTheWholeSphereCoverAllDirections) {
  const EnvironmentMap all = EnvironmentMap::Uniform(Color::Ones());
  for (const int count : {3, 4, 5, 7, 12, 62, 250, 1000}) {
    EXPECT_EQ(LightVoronoi(Lattice(count, -1), 64).UncoveredFraction(all), 0) << count;
  }
  // A grid with distant rows and close columns is still a grid.
  EXPECT_EQ(LightVoronoi(GridOfLights(3, 72), 64).UncoveredFraction(all), 0);
  // Duplicate directions do not count as neighbours at distance 0.
  std::vector<DirectionalLight> twice = Lattice(60, -1);
  twice.insert(twice.end(), twice.begin(), twice.end());
  EXPECT_EQ(LightVoronoi(twice, 64).UncoveredFraction(all), 0);
}

// The map of a named light is small; its pixels are larger than the cells of a thousand lights.
TEST(LightVoronoi, CellsAreFinerThanACoarseMap) {
  EXPECT_EQ(CellRows(1000, 512), 512);
  EXPECT_EQ(CellRows(12, 32), 32);
  const int rows = CellRows(1000, 32);
  EXPECT_EQ(rows % 32, 0);
  EXPECT_GE(2 * rows * rows, 100 * 1000);
  const LightVoronoi cells(Lattice(1000, -1), rows);
  const auto weights = cells.Integrate(EnvironmentMap::Uniform(Color(1, 2, 3)));
  double sum = 0;
  for (const Color& weight : weights) {
    EXPECT_NEAR(weight.x(), 4 * pi / 1000, 0.2 * 4 * pi / 1000);
    EXPECT_NEAR(weight.z(), 3 * weight.x(), 1e-9);
    sum += weight.x();
  }
  EXPECT_NEAR(sum, 4 * pi, 1e-6);
}

TEST(LightVoronoi, NeedsLights) {
  EXPECT_THAT(test::InputErrorOf([] { LightVoronoi({}, 8); }), HasSubstr("no lights"));
}

}  // namespace
}  // namespace nerf
