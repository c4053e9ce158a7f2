#include "nerf/kernels/hash_encoding_tile.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

class HashEncodingTile : public test::EverySimdLevel {
 protected:
  static HashGridLayout Layout(int features) {
    HashGridOptions options;
    options.levels = 5;
    options.features = features;
    options.log2_table_size = 9;
    options.base_resolution = 3;
    options.max_resolution = 100;
    return MakeHashGridLayout(options);
  }

  static std::vector<float> Uniform(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<float> values(count);
    for (float& value : values) value = uniform(generator);
    return values;
  }

  // Random positions, with corners and faces of the cube among them.
  static std::vector<float> Positions(std::int64_t count) {
    auto positions = Uniform(3 * count, 1);
    for (std::int64_t i = 0; i < 3 * std::min<std::int64_t>(count, 8); ++i) {
      positions[i] = static_cast<float>((i * 5) % 3) / 2.0f;
    }
    return positions;
  }
};

// The template in double is the oracle (its own tests are in hash_encoding_test.cpp).
TEST_P(HashEncodingTile, ForwardAndBackwardAgreeWithThePlainForm) {
  for (const int features : {1, 2, 4, 8}) {
    for (const std::int64_t count : {1, 63, 64, 65, 200}) {
      SCOPED_TRACE(testing::Message() << features << " features, " << count << " samples");
      const HashGridLayout layout = Layout(features);
      const int width = layout.OutputSize(), row = width + 3;
      const auto positions = Positions(count);
      const auto table = Uniform(layout.entries * features, 2);
      const std::vector<double> positions_d(positions.begin(), positions.end());
      const std::vector<double> table_d(table.begin(), table.end());
      const std::vector<float> level_weight = {1.0f, 1.0f, 0.5f, 0.25f, 0.0f};

      std::vector<float> encoded(count * row, -7.0f);
      HashEncodeTile(layout, table.data(), positions.data(), count, level_weight, encoded.data(),
                     row);
      std::vector<double> expected(count * width);
      HashEncodeForward<double>(layout, table_d, positions_d, expected, 0, count);
      for (std::int64_t i = 0; i < count; ++i) {
        for (int f = 0; f < width; ++f) {
          EXPECT_NEAR(encoded[i * row + f],
                      static_cast<double>(level_weight[f / features]) * expected[i * width + f],
                      2e-5);  // a float position times resolution 100 has that much rounding
        }
        for (int f = width; f < row; ++f) EXPECT_EQ(encoded[i * row + f], -7.0f);
      }

      auto dL_dencoded = Uniform(count * row, 3);
      std::vector<double> weighted(count * width);
      for (std::int64_t i = 0; i < count; ++i) {
        for (int f = 0; f < width; ++f) {
          weighted[i * width + f] = static_cast<double>(level_weight[f / features]) *
                                    static_cast<double>(dL_dencoded[i * row + f]);
        }
      }
      std::vector<double> dL_dtable_d(table.size(), 1.0);
      std::vector<float> dL_dtable(table.size(), 1.0f);
      const int levels = static_cast<int>(layout.levels.size());
      HashEncodeBackward<double>(layout, positions_d, weighted, dL_dtable_d, 0, levels);
      for (int l = 0; l < levels; ++l) {
        HashScatterLevel(layout, l, level_weight[l], positions.data(), dL_dencoded.data(), row,
                         count, dL_dtable.data());
      }
      for (std::size_t i = 0; i < table.size(); ++i) {
        EXPECT_NEAR(dL_dtable[i], dL_dtable_d[i], 1e-4);
      }
    }
  }
}

NERF_FOR_EVERY_SIMD_LEVEL(HashEncodingTile);

}  // namespace
}  // namespace nerf::kernels
