#include "nerf/kernels/matrix_product.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/simd_levels.h"

namespace nerf::kernels {
namespace {

std::vector<float> RandomFloats(std::int64_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal;
  std::vector<float> values(count);
  for (float& value : values) value = normal(generator);
  return values;
}

struct Shape {
  std::int64_t rows, inner, columns;
};

class MatrixProducts : public test::EverySimdLevel {
 protected:
  // Largest error against a sum in double, in units of the rounding of a float sum.
  static void ExpectRight(const Shape& shape, bool transposed, Epilogue epilogue) {
    SCOPED_TRACE(testing::Message() << shape.rows << "x" << shape.inner << "x" << shape.columns
                                    << (transposed ? " transposed" : ""));
    const auto a = RandomFloats(shape.rows * shape.inner, 1);
    const auto b = RandomFloats(shape.inner * shape.columns, 2);
    const auto before = RandomFloats(shape.rows * shape.columns, 3);
    auto c = before;
    MatrixProduct product;
    product.a = a.data();
    product.a_row = transposed ? 1 : shape.inner;
    product.a_inner = transposed ? shape.rows : 1;
    product.b = b.data();
    product.b_row = shape.columns;
    product.c = c.data();
    product.c_row = shape.columns;
    product.rows = shape.rows;
    product.inner = shape.inner;
    product.columns = shape.columns;
    Multiply(product, epilogue);
    for (std::int64_t r = 0; r < shape.rows; ++r) {
      for (std::int64_t j = 0; j < shape.columns; ++j) {
        double sum = 0, size = 1;
        for (std::int64_t k = 0; k < shape.inner; ++k) {
          const double term = static_cast<double>(a[r * product.a_row + k * product.a_inner]) *
                              static_cast<double>(b[k * shape.columns + j]);
          sum += term;
          size += std::fabs(term);
        }
        const float old = before[r * shape.columns + j];
        double expected = sum;
        if (epilogue == Epilogue::kAdd) expected += static_cast<double>(old);
        if (epilogue == Epilogue::kStoreRelu) expected = std::max(sum, 0.0);
        if (epilogue == Epilogue::kStoreMasked) expected = old > 0 ? sum : 0.0;
        ASSERT_NEAR(static_cast<double>(c[r * shape.columns + j]), expected,
                    1e-7 * size * static_cast<double>(shape.inner + 2));
      }
    }
  }
};

TEST_P(MatrixProducts, AgreeWithPlainLoops) {
  for (const Shape& shape : {Shape{1, 1, 16}, Shape{6, 32, 64}, Shape{7, 3, 16}, Shape{11, 64, 48},
                             Shape{256, 31, 64}, Shape{65, 64, 80}, Shape{0, 5, 16}}) {
    for (const bool transposed : {false, true}) {
      for (const Epilogue epilogue :
           {Epilogue::kStore, Epilogue::kAdd, Epilogue::kStoreRelu, Epilogue::kStoreMasked}) {
        ExpectRight(shape, transposed, epilogue);
      }
    }
  }
}

TEST_P(MatrixProducts, PropagateNaNThroughTheReLU) {
  std::vector<float> a = {NAN}, b(16, 1.0f), c(16, 0.0f);
  MatrixProduct product{a.data(), 1, 1, b.data(), 16, c.data(), 16, 1, 1, 16};
  Multiply(product, Epilogue::kStoreRelu);
  for (const float value : c) EXPECT_TRUE(std::isnan(value));
}

NERF_FOR_EVERY_SIMD_LEVEL(MatrixProducts);

}  // namespace
}  // namespace nerf::kernels
