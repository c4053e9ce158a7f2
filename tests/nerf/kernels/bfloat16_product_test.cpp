#include "nerf/kernels/bfloat16_product.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

float Lower(std::uint32_t pair) { return std::bit_cast<float>(pair << 16); }
float Upper(std::uint32_t pair) { return std::bit_cast<float>(pair & 0xffff0000u); }

// To nearest, ties to even, in double: 8 bits of mantissa.
float RoundedToBfloat16(float value) {
  int exponent = 0;
  const double mantissa = std::frexp(static_cast<double>(value), &exponent);  // [1/2, 1)
  return static_cast<float>(std::ldexp(std::nearbyint(mantissa * 256), exponent - 8));
}

std::vector<float> Random(std::int64_t size, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal;
  std::vector<float> values(size);
  for (float& v : values) v = normal(generator);
  return values;
}

class Bfloat16 : public test::EverySimdLevel {};

TEST_P(Bfloat16, PairsHoldTheNearestNumbers) {
  constexpr std::int64_t kRows = 5, kColumns = 48;
  std::vector<float> from = Random(kRows * kColumns, 3);
  from[0] = 1.00390625f;  // 1 + 2^-8, half way: to even, 1
  from[1] = 1.01171875f;  // 1 + 3 2^-8, half way: to even, 1 + 4 2^-8
  from[2] = -0.0f;
  std::vector<std::uint32_t> columns(kRows * kColumns / 2), rows(3 * kColumns);
  PairColumns(from.data(), kColumns, kRows, kColumns, columns.data());
  PairRows(from.data(), kColumns, kRows, kColumns, rows.data());
  for (std::int64_t r = 0; r < kRows; ++r) {
    for (std::int64_t c = 0; c < kColumns; ++c) {
      const float expected = RoundedToBfloat16(from[r * kColumns + c]);
      const std::uint32_t across = columns[r * kColumns / 2 + c / 2];
      EXPECT_EQ(c % 2 == 0 ? Lower(across) : Upper(across), expected);
      const std::uint32_t down = rows[r / 2 * kColumns + c];
      EXPECT_EQ(r % 2 == 0 ? Lower(down) : Upper(down), expected);
    }
  }
  for (std::int64_t c = 0; c < kColumns; ++c) EXPECT_EQ(Upper(rows[2 * kColumns + c]), 0.0f);
  EXPECT_EQ(Lower(columns[0]), 1.0f);
  EXPECT_EQ(Upper(columns[0]), 1.015625f);
}

TEST_P(Bfloat16, InfinityAndNanStayWhatTheyAre) {
  std::vector<float> from(16, 0.0f);
  from[0] = std::numeric_limits<float>::infinity();
  from[1] = -from[0];
  from[2] = std::nanf("");
  from[3] = std::bit_cast<float>(0x7f800001u);  // would round to infinity
  from[4] = std::bit_cast<float>(0x7fffffffu);  // would overflow into -0
  std::vector<std::uint32_t> pairs(8);
  PairColumns(from.data(), 16, 1, 16, pairs.data());
  EXPECT_EQ(Lower(pairs[0]), from[0]);
  EXPECT_EQ(Upper(pairs[0]), from[1]);
  EXPECT_TRUE(std::isnan(Lower(pairs[1])));
  EXPECT_TRUE(std::isnan(Upper(pairs[1])));
  EXPECT_TRUE(std::isnan(Lower(pairs[2])));
}

// The guaranteed bound: two factors, each with a relative error of at most 2^-9.
TEST_P(Bfloat16, ProductsAreOffByLessThanTheRoundingOfTheirFactors) {
  for (const auto& [rows, inner, columns] :
       {std::array<std::int64_t, 3>{1, 16, 16}, {13, 32, 64}, {37, 64, 80}, {256, 64, 64}}) {
    const std::vector<float> a = Random(rows * inner, 1), b = Random(inner * columns, 2);
    std::vector<std::uint32_t> a_pairs(rows * inner / 2), b_pairs(inner / 2 * columns);
    PairColumns(a.data(), inner, rows, inner, a_pairs.data());
    PairRows(b.data(), columns, inner, columns, b_pairs.data());
    std::vector<float> c(rows * columns);
    const Bfloat16Product product = {a_pairs.data(), inner / 2, 1,    b_pairs.data(), columns,
                                     c.data(),       columns,   rows, inner / 2,      columns};
    Multiply(product, Epilogue::kStore);
    double largest = 0;
    for (std::int64_t r = 0; r < rows; ++r) {
      for (std::int64_t j = 0; j < columns; ++j) {
        double exact = 0, size = 0, rounded = 0;
        for (std::int64_t k = 0; k < inner; ++k) {
          const double x = a[r * inner + k], y = b[k * columns + j];
          exact += x * y;
          size += std::fabs(x * y);
          rounded += static_cast<double>(RoundedToBfloat16(a[r * inner + k])) *
                     static_cast<double>(RoundedToBfloat16(b[k * columns + j]));
        }
        const double got = c[r * columns + j];
        EXPECT_LE(std::fabs(got - exact), 1.01 * std::ldexp(size, -8));
        EXPECT_NEAR(got, rounded, 1e-5 * size);  // sums are float
        largest = std::max(largest, std::fabs(got - exact) / size);
      }
    }
    EXPECT_GT(largest, 1e-5);  // factors were rounded
  }
}

TEST_P(Bfloat16, EveryEpilogueDoesWhatItDoesInFloat) {
  constexpr std::int64_t kRows = 11, kInner = 32, kColumns = 48;
  std::vector<float> a = Random(kRows * kInner, 4), b = Random(kInner * kColumns, 5);
  for (float& v : a) v = RoundedToBfloat16(v);  // then both engines multiply the same numbers
  for (float& v : b) v = RoundedToBfloat16(v);
  std::vector<std::uint32_t> a_pairs(a.size() / 2), b_pairs(b.size() / 2);
  PairColumns(a.data(), kInner, kRows, kInner, a_pairs.data());
  PairRows(b.data(), kColumns, kInner, kColumns, b_pairs.data());
  for (const Epilogue epilogue :
       {Epilogue::kStore, Epilogue::kAdd, Epilogue::kStoreRelu, Epilogue::kStoreMasked}) {
    std::vector<float> expected = Random(kRows * kColumns, 6), c = expected;
    Multiply(MatrixProduct{a.data(), kInner, 1, b.data(), kColumns, expected.data(), kColumns,
                           kRows, kInner, kColumns},
             epilogue);
    Multiply(Bfloat16Product{a_pairs.data(), kInner / 2, 1, b_pairs.data(), kColumns, c.data(),
                             kColumns, kRows, kInner / 2, kColumns},
             epilogue);
    for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(c[i], expected[i], 1e-4);
  }
}

TEST_P(Bfloat16, NanReachesTheResult) {
  std::vector<float> a(16, 1.0f), b(16 * 16, 1.0f), c(16, 0.0f);
  b[3] = std::nanf("");
  std::vector<std::uint32_t> a_pairs(8), b_pairs(8 * 16);
  PairColumns(a.data(), 16, 1, 16, a_pairs.data());
  PairRows(b.data(), 16, 16, 16, b_pairs.data());
  Multiply(Bfloat16Product{a_pairs.data(), 8, 1, b_pairs.data(), 16, c.data(), 16, 1, 8, 16},
           Epilogue::kStoreRelu);
  EXPECT_TRUE(std::isnan(c[3]));
  EXPECT_EQ(c[4], 16.0f);
}

NERF_FOR_EVERY_SIMD_LEVEL(Bfloat16);

}  // namespace
}  // namespace nerf::kernels
