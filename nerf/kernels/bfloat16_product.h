#pragma once

#include <cstdint>

#include "nerf/kernels/matrix_product.h"

namespace nerf::kernels {

// Products of matrices rounded to bfloat16 (the upper 16 bits of a float, rounded to nearest even:
// a relative error of at most 2^-9 per factor), accumulated in float. Processors with native
// bfloat16 products (AVX512-BF16) compute twice as many in the same time as of float; others
// emulate them.
//
// Factors are stored as pairs along the inner dimension: element 2k in the lower half of an
// integer, 2k + 1 in the upper half.

// Whether this processor has native bfloat16 products.
bool HasBfloat16Products();

// Packs neighbours in a row.
//   from   [rows, columns], rows `row` floats apart, columns a multiple of kRowPadding
//   pairs  [rows, columns / 2] written
void PairColumns(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
                 std::uint32_t* pairs);

// Packs neighbours in a column; the last row of an odd number is paired with zeros.
//   from   [rows, columns], likewise
//   pairs  [(rows + 1) / 2, columns] written
void PairRows(const float* from, std::int64_t row, std::int64_t rows, std::int64_t columns,
              std::uint32_t* pairs);

// MatrixProduct of packed factors: `inner` and the strides of a and b count pairs.
struct Bfloat16Product {
  const std::uint32_t* a = nullptr;
  std::int64_t a_row = 0, a_inner = 1;
  const std::uint32_t* b = nullptr;
  std::int64_t b_row = 0;
  float* c = nullptr;
  std::int64_t c_row = 0;
  std::int64_t rows = 0, inner = 0, columns = 0;
};
void Multiply(const Bfloat16Product& product, Epilogue epilogue);

}  // namespace nerf::kernels
