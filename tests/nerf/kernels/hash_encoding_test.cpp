#include "nerf/kernels/hash_encoding.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "nerf/reference/hash_encoding.h"

namespace nerf::kernels {
namespace {

HashGridOptions SmallGrid() {
  HashGridOptions options;
  options.levels = 6;
  options.features = 2;
  options.log2_table_size = 10;
  options.base_resolution = 4;
  options.max_resolution = 128;
  return options;
}

std::vector<double> RandomTable(const HashGridLayout& layout, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<double> table(layout.entries * layout.features);
  for (double& v : table) v = normal(rng);
  return table;
}

std::vector<double> Encode(const HashGridLayout& layout, const std::vector<double>& table,
                           const std::vector<double>& positions) {
  const auto count = static_cast<std::int64_t>(positions.size() / 3);
  std::vector<double> encoded(count * layout.OutputSize());
  HashEncodeForward<double>(layout, table, positions, encoded, 0, count);
  return encoded;
}

TEST(HashGridLayout, LevelsGrowGeometricallyFromDenseToHashed) {
  const HashGridLayout layout = MakeHashGridLayout(SmallGrid());
  ASSERT_EQ(layout.levels.size(), 6u);
  EXPECT_EQ(layout.levels.front().resolution, 4u);
  EXPECT_EQ(layout.levels.back().resolution, 128u);
  EXPECT_TRUE(layout.levels.front().dense);
  EXPECT_EQ(layout.levels.front().size, 125u);
  EXPECT_FALSE(layout.levels.back().dense);
  EXPECT_EQ(layout.levels.back().size, 1024u);
  std::int64_t offset = 0;
  for (const HashGridLevel& level : layout.levels) {
    EXPECT_EQ(level.offset, offset);
    offset += level.size;
  }
  EXPECT_EQ(layout.entries, offset);
}

TEST(HashGridLayout, DenseLevelsGiveEveryVertexItsOwnEntry) {
  const HashGridLevel level = MakeHashGridLayout(SmallGrid()).levels.front();
  std::set<std::uint32_t> entries;
  for (std::uint32_t x = 0; x <= 4; ++x) {
    for (std::uint32_t y = 0; y <= 4; ++y) {
      for (std::uint32_t z = 0; z <= 4; ++z)
        entries.insert(reference::HashGridEntry(level, x, y, z));
    }
  }
  EXPECT_EQ(entries.size(), 125u);
  EXPECT_EQ(*entries.rbegin(), 124u);
}

TEST(HashEncoding, WeightsSumToOneEverywhere) {
  for (const int features : {1, 2, 4, 8}) {
    HashGridOptions options = SmallGrid();
    options.features = features;
    const HashGridLayout layout = MakeHashGridLayout(options);
    const std::vector<double> ones(layout.entries * features, 1.0);
    for (const double u : {0.0, 0.25, 1.0 / 3, 0.5, 0.999999, 1.0}) {
      for (const double e : Encode(layout, ones, {u, 1 - u, u * u})) EXPECT_NEAR(e, 1.0, 1e-12);
    }
  }
}

TEST(HashEncoding, AtAVertexReturnsItsEntry) {
  HashGridOptions options = SmallGrid();
  options.levels = 1;
  const HashGridLayout layout = MakeHashGridLayout(options);
  const std::vector<double> table = RandomTable(layout, 1);
  // The last vertex too, which belongs to the cell before it.
  for (const auto& v : {std::array{0u, 0u, 0u}, {1u, 2u, 3u}, {4u, 4u, 4u}, {4u, 0u, 2u}}) {
    const auto encoded = Encode(layout, table, {v[0] / 4.0, v[1] / 4.0, v[2] / 4.0});
    const auto entry = reference::HashGridEntry(layout.levels[0], v[0], v[1], v[2]);
    EXPECT_DOUBLE_EQ(encoded[0], table[2 * entry]);
    EXPECT_DOUBLE_EQ(encoded[1], table[2 * entry + 1]);
  }
}

// The eight corners by three nested loops and interpolation axis by axis.
TEST(HashEncoding, MatchesInterpolationAxisByAxis) {
  const HashGridLayout layout = MakeHashGridLayout(SmallGrid());
  const std::vector<double> table = RandomTable(layout, 2);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 200; ++n) {
    const double p[3] = {uniform(rng), uniform(rng), uniform(rng)};
    const auto encoded = Encode(layout, table, {p[0], p[1], p[2]});
    for (std::size_t l = 0; l < layout.levels.size(); ++l) {
      const HashGridLevel& level = layout.levels[l];
      std::uint32_t c[3];
      double f[3];
      for (int a = 0; a < 3; ++a) {
        c[a] = static_cast<std::uint32_t>(p[a] * level.resolution);
        f[a] = p[a] * level.resolution - c[a];
      }
      for (int feature = 0; feature < 2; ++feature) {
        const auto at = [&](int x, int y, int z) {
          const auto entry = reference::HashGridEntry(level, c[0] + x, c[1] + y, c[2] + z);
          return table[2 * (level.offset + entry) + feature];
        };
        const auto along_x = [&](int y, int z) {
          return std::lerp(at(0, y, z), at(1, y, z), f[0]);
        };
        const auto along_y = [&](int z) { return std::lerp(along_x(0, z), along_x(1, z), f[1]); };
        EXPECT_NEAR(encoded[2 * l + feature], std::lerp(along_y(0), along_y(1), f[2]), 1e-10);
      }
    }
  }
}

TEST(HashEncoding, IsContinuousAcrossCellBorders) {
  const HashGridLayout layout = MakeHashGridLayout(SmallGrid());
  const std::vector<double> table = RandomTable(layout, 4);
  for (int border = 1; border < 128; ++border) {
    const double x = border / 128.0;
    const auto below = Encode(layout, table, {x - 1e-9, 0.3, 0.7});
    const auto above = Encode(layout, table, {x + 1e-9, 0.3, 0.7});
    for (std::size_t i = 0; i < below.size(); ++i) EXPECT_NEAR(below[i], above[i], 1e-5);
  }
}

// <dL/dencoded, encode(table)> is linear in the table: its gradient must be the adjoint.
TEST(HashEncoding, BackwardIsTheAdjointOfForward) {
  for (const int features : {1, 2, 4, 8}) {
    HashGridOptions options = SmallGrid();
    options.features = features;
    const HashGridLayout layout = MakeHashGridLayout(options);
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<double> positions(3 * 100), dL_dencoded(100 * layout.OutputSize());
    for (double& p : positions) p = uniform(rng);
    for (double& g : dL_dencoded) g = uniform(rng) - 0.5;
    const std::vector<double> table = RandomTable(layout, 6);
    const std::vector<double> encoded = Encode(layout, table, positions);
    std::vector<double> dL_dtable(table.size(), 0.0);
    HashEncodeBackward<double>(layout, positions, dL_dencoded, dL_dtable, 0, options.levels);
    double forward = 0, backward = 0;
    for (std::size_t i = 0; i < encoded.size(); ++i) forward += encoded[i] * dL_dencoded[i];
    for (std::size_t i = 0; i < table.size(); ++i) backward += table[i] * dL_dtable[i];
    EXPECT_NEAR(forward, backward, 1e-9 * std::fabs(forward) + 1e-9);
  }
}

TEST(HashEncoding, AGradientReachesExactlyTheEightCorners) {
  HashGridOptions options = SmallGrid();
  options.levels = 1;
  const HashGridLayout layout = MakeHashGridLayout(options);
  std::vector<double> dL_dtable(layout.entries * 2, 0.0);
  const std::vector<double> position = {0.6, 0.6, 0.6}, ones = {1.0, 1.0};
  HashEncodeBackward<double>(layout, position, ones, dL_dtable, 0, 1);
  int touched = 0;
  for (std::int64_t e = 0; e < layout.entries; ++e) touched += dL_dtable[2 * e] != 0.0;
  EXPECT_EQ(touched, 8);
}

}  // namespace
}  // namespace nerf::kernels
